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

/// A name for a file made of words that may hold anything, such as a scene's name.
pub(crate) fn from_words(words: &[&str]) -> String {
    let harmless =
        |character: char| if character.is_alphanumeric() || "-_.".contains(character) { character } else { '_' };
    words.join("-").chars().map(harmless).collect()
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
}
