//! Names of the files of a sequence.

use std::path::{Path, PathBuf};

/// Digits of a frame number in a name that does not say how many.
const DIGITS: usize = 4;

/// The file of one frame: the first run of two or more `#` in the name is replaced by the number, as wide as the run;
/// a name without one gets the number before its extension, `out.0007.exr`.
pub(crate) fn numbered(path: &Path, frame: u32) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if let Some(name) = fill_pattern(&name, frame) {
        return path.with_file_name(name);
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().map(|extension| format!(".{}", extension.to_string_lossy())).unwrap_or_default();
    path.with_file_name(format!("{stem}.{frame:0DIGITS$}{extension}"))
}

/// The file of a frame that is rendered alone: the name as it is, unless it has a place for the number.
pub(crate) fn single(path: &Path, frame: u32) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    fill_pattern(&name, frame).map_or_else(|| path.to_owned(), |name| path.with_file_name(name))
}

/// Bytes of a name made of words; with an extension it is well below the 255 that names may have.
const LONGEST: usize = 240;

/// A name for a file made of words that may hold anything, such as a scene's name. Of one that is too long the middle is
/// replaced by a number that tells it from others of the same ends.
pub(crate) fn from_words(words: &[&str]) -> String {
    let harmless =
        |character: char| if character.is_alphanumeric() || "-_.".contains(character) { character } else { '_' };
    let name: String = words.join("-").chars().map(harmless).collect();
    if name.len() <= LONGEST {
        return name;
    }
    let number = blake3::hash(name.as_bytes()).to_hex();
    let whole = |at: &usize| name.is_char_boundary(*at);
    let start = (0..LONGEST / 2).rfind(whole).unwrap_or_default();
    let end = (name.len() - LONGEST / 4..name.len()).find(whole).unwrap_or(name.len());
    format!("{}-{}-{}", &name[..start], &number[..16], &name[end..])
}

fn fill_pattern(name: &str, frame: u32) -> Option<String> {
    let start = name.find("##")?;
    let digits = name[start..].chars().take_while(|character| *character == '#').count();
    Some(format!("{}{frame:0digits$}{}", &name[..start], &name[start + digits..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_where_the_name_says() {
        let name = |path: &str, frame| numbered(Path::new(path), frame).to_string_lossy().into_owned();
        assert_eq!(name("out.exr", 7), "out.0007.exr");
        assert_eq!(name("dir.a/out.exr", 12345), "dir.a/out.12345.exr");
        assert_eq!(name("a.####.b.png", 7), "a.0007.b.png");
        assert_eq!(name("##/a###.png", 7), "##/a007.png", "only the name is a pattern");
        assert_eq!(name("scene#1.png", 7), "scene#1.0007.png");
        assert_eq!(single(Path::new("out.exr"), 7), Path::new("out.exr"));
        assert_eq!(single(Path::new("out.####.exr"), 7), Path::new("out.0007.exr"));
    }

    #[test]
    fn names_from_words_stay_in_their_folder() {
        assert_eq!(from_words(&["../a b", "rsm"]), ".._a_b-rsm");
    }

    #[test]
    fn names_from_words_are_as_long_as_names_may_be() {
        let [one, other] = ["x", "y"].map(|middle| from_words(&[&"台".repeat(60), middle, &"所".repeat(60), "draft"]));
        assert!(one.len() + ".png".len() <= 255 && one != other && one.ends_with("-draft"), "{one} {other}");
    }
}
