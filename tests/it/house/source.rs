//! Reads which files of a crate use which others, from their text alone.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A module's path from the root of the crate.
type Module = Vec<String>;

/// The files of a crate's library and program, without their tests.
pub(crate) struct Tree {
    modules: BTreeMap<Module, File>,
}

struct File {
    path: PathBuf,
    tokens: Vec<String>,
    items: BTreeSet<String>,
    /// What `use` brings in: a name here, and the path behind it.
    names: BTreeMap<String, Vec<String>>,
    /// Paths whose every name is brought in.
    globs: Vec<Vec<String>>,
}

impl Tree {
    /// All files below `root` but those of tests.
    pub(crate) fn read(root: &Path) -> Tree {
        let mut found = Vec::new();
        let mut folders = vec![root.to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).expect("a folder of sources") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "rs") {
                    let text = fs::read_to_string(&path).expect("sources are text");
                    found.push((path.strip_prefix(root).expect("below the root").to_owned(), text));
                }
            }
        }
        Tree::of(found)
    }

    /// The same of files given by path and text.
    pub(crate) fn of(files: impl IntoIterator<Item = (PathBuf, String)>) -> Tree {
        let is_test = |path: &Path| {
            path.iter().any(|part| ["tests", "tests.rs", "gpu_tests", "twins"].contains(&&*part.to_string_lossy()))
        };
        let files = files.into_iter().filter(|(path, _)| !is_test(path));
        Tree { modules: files.map(|(path, text)| (module_of(&path), File::new(path, &text))).collect() }
    }

    pub(crate) fn files(&self) -> impl Iterator<Item = &Path> {
        self.modules.values().map(|file| &*file.path)
    }

    /// Pairs of files of which the first uses the second.
    pub(crate) fn edges(&self) -> BTreeSet<(PathBuf, PathBuf)> {
        let mut edges = BTreeSet::new();
        for (module, file) in &self.modules {
            let uses = file.names.values().chain(&file.globs).cloned();
            for path in uses.chain(paths_in(&file.tokens)) {
                let used = self.resolve(module, &path, 0).and_then(|module| self.modules.get(&module));
                if let Some(used) = used.filter(|used| used.path != file.path) {
                    edges.insert((file.path.clone(), used.path.clone()));
                }
            }
        }
        edges
    }

    /// The module that has the item that `path` names in `module`.
    fn resolve(&self, module: &Module, path: &[String], depth: u32) -> Option<Module> {
        if depth > 16 {
            return None;
        }
        let mut rest = path;
        let mut at = module.clone();
        match rest.first()?.as_str() {
            "crate" | "irradia" => at = Vec::new(),
            "self" | "super" => {}
            first if self.modules.contains_key(&[&module[..], &[first.to_owned()]].concat()) => {}
            _ => return None,
        }
        if ["crate", "irradia", "self"].contains(&rest[0].as_str()) {
            rest = &rest[1..];
        }
        while rest.first().is_some_and(|part| part == "super") {
            at.pop();
            rest = &rest[1..];
        }
        while let Some(part) = rest.first() {
            let child = [&at[..], std::slice::from_ref(part)].concat();
            if self.modules.contains_key(&child) {
                at = child;
                rest = &rest[1..];
                continue;
            }
            let file = self.modules.get(&at)?;
            if file.defines(part) {
                return Some(at);
            }
            if let Some(behind) = file.names.get(part) {
                let further = [behind, &rest[1..]].concat();
                return self.resolve(&at, &further, depth + 1).or(Some(at));
            }
            let through = file.globs.iter().find_map(|glob| {
                let target = self.resolve(&at, glob, depth + 1)?;
                self.modules.get(&target)?.defines(part).then_some(target)
            });
            return through.or(Some(at));
        }
        Some(at)
    }
}

/// `a/b.rs` and `a/b/mod.rs` are the module a::b.
fn module_of(path: &Path) -> Module {
    let mut parts: Module = path.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if parts.last().is_some_and(|last| last == "mod") || parts == ["lib"] {
        parts.pop();
    }
    parts
}

impl File {
    fn new(path: PathBuf, text: &str) -> File {
        let tokens = without_tests(tokens_of(text));
        let (mut names, mut globs) = (BTreeMap::new(), Vec::new());
        for (index, _) in tokens.iter().enumerate().filter(|(_, token)| *token == "use") {
            // `impl Trait + use<>` brings nothing in.
            if tokens.get(index + 1).is_some_and(|next| next == "<") {
                continue;
            }
            read_use(&tokens[index + 1..], &mut Vec::new(), &mut names, &mut globs);
        }
        File { path, items: items_of(&tokens), tokens, names, globs }
    }

    /// Whether the file itself has an item of this name.
    fn defines(&self, name: &str) -> bool {
        self.items.contains(name)
    }
}

/// The names of a file's items: not of what stands inside of other items.
fn items_of(tokens: &[String]) -> BTreeSet<String> {
    let kinds = ["fn", "struct", "enum", "trait", "const", "static", "type", "union", "mod"];
    let (mut items, mut depth) = (BTreeSet::new(), 0);
    for (at, token) in tokens.iter().enumerate() {
        match token.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            "macro_rules" if depth == 0 => items.extend(tokens.get(at + 2).cloned()),
            kind if depth == 0 && kinds.contains(&kind) => items.extend(tokens.get(at + 1).cloned()),
            _ => {}
        }
    }
    items
}

/// Reads one tree of a `use`, up to the `;`, `,` or `}` that ends it; returns the tokens read.
fn read_use(
    tokens: &[String],
    prefix: &mut Vec<String>,
    names: &mut BTreeMap<String, Vec<String>>,
    globs: &mut Vec<Vec<String>>,
) -> usize {
    let (start, mut at) = (prefix.len(), 0);
    while let Some(token) = tokens.get(at) {
        match token.as_str() {
            ";" | "," | "}" => break,
            "::" => at += 1,
            "*" => {
                globs.push(prefix.clone());
                at += 1;
            }
            "as" => {
                let path = prefix.clone();
                names.insert(tokens[at + 1].clone(), path);
                prefix.truncate(start);
                return at + 2;
            }
            "{" => {
                at += 1;
                while tokens.get(at).is_some_and(|token| token != "}") {
                    at += read_use(&tokens[at..], prefix, names, globs);
                    at += usize::from(tokens.get(at).is_some_and(|token| token == ","));
                }
                prefix.truncate(start);
                return at + 1;
            }
            "self" if !prefix.is_empty() => at += 1,
            word => {
                prefix.push(word.to_owned());
                at += 1;
            }
        }
    }
    if let Some(last) = prefix.last().filter(|_| tokens[..at].last().is_none_or(|token| token != "*")) {
        names.insert(last.clone(), prefix.clone());
    }
    prefix.truncate(start);
    at
}

/// The paths outside of `use` trees.
fn paths_in(tokens: &[String]) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let starts = is_word(&tokens[at]) && tokens.get(at + 1).is_some_and(|token| token == "::");
        if !starts || (at > 0 && tokens[at - 1] == "::") {
            at += 1;
            continue;
        }
        let mut path = vec![tokens[at].clone()];
        while tokens.get(at + 1).is_some_and(|token| token == "::")
            && tokens.get(at + 2).is_some_and(|token| is_word(token))
        {
            path.push(tokens[at + 2].clone());
            at += 2;
        }
        // One name alone says nothing: `crate::{…}` is a `use`.
        if path.len() > 1 {
            paths.push(path);
        }
        at += 1;
    }
    paths
}

fn is_word(token: &str) -> bool {
    token.starts_with(|letter: char| letter.is_alphabetic() || letter == '_')
}

/// Without modules that only tests are compiled with.
fn without_tests(tokens: Vec<String>) -> Vec<String> {
    let mark = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if !tokens[at..].iter().take(mark.len()).eq(mark.iter()) {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        // To the end of the item: its block, or its semicolon.
        let mut depth = 0;
        at += mark.len();
        while let Some(token) = tokens.get(at) {
            at += 1;
            match token.as_str() {
                "{" => depth += 1,
                "}" if depth == 1 => break,
                "}" => depth -= 1,
                ";" if depth == 0 => break,
                _ => {}
            }
        }
    }
    kept
}

/// Words, `::` and single other characters; no comments, no strings.
fn tokens_of(text: &str) -> Vec<String> {
    let letters: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(&letter) = letters.get(at) {
        let next = letters.get(at + 1).copied().unwrap_or(' ');
        let end_of = |from: usize, ends: &dyn Fn(usize) -> bool| {
            (from..letters.len()).find(|&place| ends(place)).unwrap_or(letters.len())
        };
        match (letter, next) {
            ('/', '/') => at = end_of(at, &|place| letters[place] == '\n'),
            ('/', '*') => at = end_of(at + 2, &|place| letters[place] == '/' && letters[place - 1] == '*') + 1,
            ('r', '"' | '#') if raw_string(&letters[at..]).is_some() => at += raw_string(&letters[at..]).unwrap_or(1),
            ('"', _) => {
                at += 1;
                while at < letters.len() && letters[at] != '"' {
                    at += if letters[at] == '\\' { 2 } else { 1 };
                }
                at += 1;
            }
            ('\'', '\\') => at = end_of(at + 3, &|place| letters[place] == '\'') + 1,
            ('\'', _) if letters.get(at + 2) == Some(&'\'') => at += 3,
            (':', ':') => {
                tokens.push("::".to_owned());
                at += 2;
            }
            _ if letter.is_alphanumeric() || letter == '_' => {
                let end = end_of(at, &|place| !letters[place].is_alphanumeric() && letters[place] != '_');
                tokens.push(letters[at..end].iter().collect());
                at = end;
            }
            _ => {
                if !letter.is_whitespace() {
                    tokens.push(letter.to_string());
                }
                at += 1;
            }
        }
    }
    tokens
}

/// The length of the raw string that `letters` start with.
fn raw_string(letters: &[char]) -> Option<usize> {
    let hashes = letters[1..].iter().take_while(|&&letter| letter == '#').count();
    if letters.get(1 + hashes) != Some(&'"') {
        return None;
    }
    let end: Vec<char> = std::iter::once('"').chain(std::iter::repeat_n('#', hashes)).collect();
    let body = 2 + hashes;
    letters[body..].windows(end.len()).position(|window| window == end).map(|place| body + place + end.len())
}
