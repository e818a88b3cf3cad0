//! Names of passes: the piece that a pass belongs to, and the levels within it.
//!
//! `caustics/photons/lists/clear` is the pass `lists/clear` of the piece `caustics/photons`; `caustics/photons/lists` is a level of that piece.

use crate::slot::Slot;

/// The piece of the pass called `name`, a slot with its method or else the first word; and the pass within it.
pub(super) fn split(name: &str) -> (&str, &str) {
    let Some((first, rest)) = name.split_once('/') else { return (name, "") };
    if Slot::from_name(first).is_none() {
        return (first, rest);
    }
    let end = rest.find('/').map_or(name.len(), |end| first.len() + 1 + end);
    (&name[..end], name[end..].trim_start_matches('/'))
}

/// The full name of a pass; a piece without passes goes by its own.
pub(crate) fn joined(piece: &str, pass: &str) -> String {
    if pass.is_empty() { piece.to_owned() } else { format!("{piece}/{pass}") }
}

/// Whether the pass, level or piece called `name` is `piece` or lies within it.
pub(crate) fn lies_in(name: &str, piece: &str) -> bool {
    name.strip_prefix(piece).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

/// The piece of a pass and the levels that it lies in, from the outermost.
pub(crate) fn levels(piece: &str, pass: &str) -> Vec<String> {
    let ends = pass.match_indices('/').map(|(end, _)| joined(piece, &pass[..end]));
    [piece.to_owned()].into_iter().chain(ends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_and_its_method_are_a_piece() {
        assert_eq!(split("caustics/photons/lists/clear"), ("caustics/photons", "lists/clear"));
        assert_eq!(split("diffuse/rsm/gather"), ("diffuse/rsm", "gather"));
        assert_eq!(split("direct/traced"), ("direct/traced", ""));
        assert_eq!(split("direct"), ("direct", ""));
        assert_eq!(split("light-views/depth"), ("light-views", "depth"));
        assert_eq!(split("path/light/emit"), ("path", "light/emit"));
        for name in ["caustics/photons/lists/clear", "direct/traced", "compose/image", "light-views"] {
            let (piece, pass) = split(name);
            assert_eq!(joined(piece, pass), name);
        }
    }

    #[test]
    fn levels_end_at_slashes() {
        assert_eq!(levels("a/b", "c/d/e"), ["a/b", "a/b/c", "a/b/c/d"]);
        assert_eq!(levels("a", "b"), ["a"]);
        assert!(lies_in("a/b/c", "a/b") && lies_in("a/b", "a/b"));
        assert!(!lies_in("a/bc", "a/b") && !lies_in("a", "a/b"));
    }
}
