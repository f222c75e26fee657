//! What a source file imports, read off its text.

/// The paths that a file names from `crate`, with their lines: those of `use` trees, one each, and those in code.
pub fn imports(path: &str, source: &str) -> Vec<(usize, Vec<String>)> {
    let here = module_of(path);
    let mut found = Vec::new();
    let mut at = 0;
    while let Some((start, root)) = next_root(source, at) {
        at = start + root.len();
        let line = source[..start].matches('\n').count() + 1;
        let mut base = if root == "crate" { Vec::new() } else { here.clone() };
        if root == "super" {
            base.pop();
        }
        let mut tree = Vec::new();
        read_tree(source.as_bytes(), &mut at, &mut base, &mut tree);
        found.extend(tree.into_iter().map(|path| (line, path)));
    }
    found
}

/// The module that a file of `src` is.
pub fn module_of(path: &str) -> Vec<String> {
    let name = path.trim_start_matches("src/").trim_end_matches(".rs").trim_end_matches("/mod");
    name.split('/').filter(|part| *part != "lib").map(str::to_owned).collect()
}

/// The next `crate::`, `super::` or `self::` that begins a path; what says who may see an item is none.
fn next_root(source: &str, from: usize) -> Option<(usize, &'static str)> {
    let begins = |at: usize| {
        let before = source[..at].chars().next_back();
        let sees = source[..at].ends_with("(in ");
        !sees && before.is_none_or(|sign| !sign.is_alphanumeric() && !matches!(sign, '_' | ':' | '$'))
    };
    let first = |root: &'static str| {
        let all = source[from..].match_indices(root).map(|(at, _)| from + at);
        let mut all = all.filter(|at| begins(*at) && source[*at + root.len()..].starts_with("::"));
        all.next().map(|at| (at, root))
    };
    ["crate", "super", "self"].into_iter().filter_map(first).min()
}

/// Reads what stands after `base`: `::a::{b, c::d}` is two paths.
fn read_tree(source: &[u8], at: &mut usize, base: &mut Vec<String>, out: &mut Vec<Vec<String>>) {
    let depth = base.len();
    while source[*at..].starts_with(b"::") {
        *at += 2;
        match source.get(*at) {
            Some(b'{') => {
                while !matches!(source.get(*at), None | Some(b'}')) {
                    *at += 1;
                    skip_space(source, at);
                    let length = base.len();
                    if let Some(word) = word(source, at) {
                        base.push(word);
                        read_tree(source, at, base, out);
                    }
                    base.truncate(length);
                    while !matches!(source.get(*at), None | Some(b',' | b'}')) {
                        *at += 1;
                    }
                }
                *at += 1;
                base.truncate(depth);
                return;
            }
            _ => match word(source, at) {
                Some(word) if word == "super" => drop(base.pop()),
                Some(word) => base.push(word),
                None => break,
            },
        }
    }
    out.push(base.clone());
    base.truncate(depth);
}

fn skip_space(source: &[u8], at: &mut usize) {
    while source.get(*at).is_some_and(u8::is_ascii_whitespace) {
        *at += 1;
    }
}

fn word(source: &[u8], at: &mut usize) -> Option<String> {
    let start = *at;
    while source.get(*at).is_some_and(|sign| sign.is_ascii_alphanumeric() || *sign == b'_') {
        *at += 1;
    }
    (*at > start).then(|| String::from_utf8_lossy(&source[start..*at]).into_owned())
}
