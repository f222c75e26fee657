//! Every dependency has a licence that goes with MIT OR Apache-2.0.

mod support;

use std::process::Command;

/// Licences that ask for no more than notices. A dependency needs one choice made of these alone.
const ALLOWED: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "NCSA",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Whether a licence expression can be met: `A OR B` by either, `A AND B` by both.
fn is_allowed(expression: &str) -> bool {
    let plain = expression.replace('/', " OR ");
    let mut rest = plain.trim();
    // The outermost brackets only: no licence expression nests deeper in practice.
    let mut alternatives = Vec::new();
    let (mut depth, mut start) = (0i32, 0);
    for (at, sign) in rest.char_indices() {
        depth += match sign {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        if depth == 0 && rest[at..].starts_with(" OR ") {
            alternatives.push(&rest[start..at]);
            start = at + 4;
        }
    }
    alternatives.push(&rest[start..]);
    if alternatives.len() > 1 {
        return alternatives.iter().any(|part| is_allowed(part));
    }
    let bracketed = |part: &str| part.starts_with('(') && part.find(')') == Some(part.len() - 1);
    if bracketed(rest) {
        rest = &rest[1..rest.len() - 1];
        return is_allowed(rest);
    }
    let mut parts = Vec::new();
    (depth, start) = (0, 0);
    for (at, sign) in rest.char_indices() {
        depth += match sign {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
        if depth == 0 && rest[at..].starts_with(" AND ") {
            parts.push(&rest[start..at]);
            start = at + 5;
        }
    }
    parts.push(&rest[start..]);
    match parts.as_slice() {
        [one] => ALLOWED.contains(&one.trim()),
        all => all.iter().all(|part| is_allowed(part)),
    }
}

#[test]
fn expressions_are_read() {
    for good in ["MIT", "MIT OR GPL-3.0", "GPL-3.0/MIT", "(MIT OR Apache-2.0) AND Unicode-3.0", "MIT AND ISC"]
    {
        assert!(is_allowed(good), "{good}");
    }
    for bad in ["GPL-3.0", "MIT AND GPL-3.0", "(MIT OR Apache-2.0) AND LGPL-2.1", "", "MPL-2.0"] {
        assert!(!is_allowed(bad), "{bad}");
    }
}

#[test]
fn every_dependency_is_allowed() {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked"])
        .current_dir(support::root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 50, "{} packages", packages.len());
    let wrong: Vec<String> = packages
        .iter()
        .filter(|package| !is_allowed(package["license"].as_str().unwrap_or_default()))
        .map(|package| format!("{} {}: {}", package["name"], package["version"], package["license"]))
        .collect();
    assert!(wrong.is_empty(), "licences to look at:\n{}", wrong.join("\n"));
}

#[test]
fn the_projects_own_licences_stand_beside_it() {
    assert!(support::text("Cargo.toml").contains("license = \"MIT OR Apache-2.0\""));
    assert!(support::text("LICENSE-MIT").contains("The macroglot contributors"));
    assert!(support::text("LICENSE-APACHE").contains("Apache License"));
    assert!(support::text("LICENSE-APACHE").contains("END OF TERMS AND CONDITIONS"));
}
