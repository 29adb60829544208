//! What the workspace promises about itself, read from `cargo metadata`: the direction of its crates, the
//! licences of everything that it builds on, and what each crate says about itself.
#![allow(clippy::unwrap_used)] // A test that cannot unwrap has failed.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use std::sync::OnceLock;

use serde_json::Value;

/// The layers, left to right. A crate names only crates of layers to its left; crates of one layer never meet.
const LAYERS: [&[&str]; 6] = [
    &["tumble-runtime"],
    &["tumble-core"],
    &["tumble-io"],
    &["tumble-report"],
    &["tumble-pdf", "tumble-bench", "tumble-fleet"],
    &["tumble"],
];

/// Licences that anything in the graph may have.
const ALLOWED: [&str; 12] = [
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Zlib",
    "Unicode-3.0",
    "CC0-1.0",
    "0BSD",
    "Unlicense",
    "BSL-1.0",
    "Apache-2.0 WITH LLVM-exception",
];

/// Licences that one package alone may have.
const ALLOWED_FOR: [(&str, &str); 2] = [
    // Weak copyleft by file; unmodified.
    ("serialport", "MPL-2.0"),
    // MIT without the duty to name the authors. Comes with `boon`, which only tests use.
    ("borrow-or-share", "MIT-0"),
];

/// Fewest packages of a graph that can be ours: less, and the metadata were not read.
const FEWEST_PACKAGES: usize = 20;

fn metadata() -> &'static Value {
    static METADATA: OnceLock<Value> = OnceLock::new();
    METADATA.get_or_init(|| {
        let output = Command::new(env!("CARGO"))
            .args(["metadata", "--format-version", "1", "--locked", "--offline"])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("cargo starts");
        assert!(
            output.status.success(),
            "cargo metadata --locked --offline failed; `cargo fetch --locked` gets the packages of all \
             platforms:\n{}",
            String::from_utf8_lossy(&output.stderr)
        );
        serde_json::from_slice(&output.stdout).expect("cargo metadata is JSON")
    })
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().unwrap_or_else(|| panic!("cargo metadata has no list `{key}`"))
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_else(|| panic!("no text `{key}` in {value:.80}"))
}

/// Packages of the workspace by name.
fn members() -> BTreeMap<&'static str, &'static Value> {
    let ids: BTreeSet<&str> =
        list(metadata(), "workspace_members").iter().filter_map(Value::as_str).collect();
    let members: BTreeMap<_, _> = list(metadata(), "packages")
        .iter()
        .filter(|p| ids.contains(text(p, "id")))
        .map(|p| (text(p, "name"), p))
        .collect();
    assert_eq!(members.len(), ids.len(), "every member is a package");
    members
}

/// Names of a package's dependencies of the given kinds; `cargo metadata` writes `null` for normal ones.
fn dependencies<'a>(package: &'a Value, kinds: &[Option<&str>]) -> Vec<&'a str> {
    list(package, "dependencies")
        .iter()
        .filter(|d| kinds.contains(&d["kind"].as_str()))
        .map(|d| text(d, "name"))
        .collect()
}

// --- direction of the crates ---

fn layer(name: &str) -> Option<usize> {
    LAYERS.iter().position(|crates| crates.contains(&name))
}

/// What is wrong with a crate that names another; `None` when nothing is.
fn wrong_direction(from: &str, to: &str) -> Option<String> {
    match (layer(from)?, layer(to)?) {
        (left, right) if left > right => None,
        (left, right) if left < right => Some(format!(
            "{from} names {to}, which lies to its right: the concept that it needs stands in the wrong place"
        )),
        _ => Some(format!("{from} names {to}: crates of one layer never meet")),
    }
}

#[test]
fn a_left_crate_never_names_a_right_one() {
    let members = members();
    for required in ["tumble-runtime", "tumble-core", "tumble-io", "tumble-report", "tumble"] {
        assert!(members.contains_key(required), "{required} is no member: {:?}", members.keys());
    }
    let mut edges = 0;
    let mut wrong = Vec::new();
    for (name, package) in &members {
        assert!(
            layer(name).is_some(),
            "{name} is a new member: give it its place in LAYERS of {} and in ARCHITECTURE.md",
            file!()
        );
        for dependency in dependencies(package, &[None, Some("build")]) {
            if members.contains_key(dependency) {
                edges += 1;
                wrong.extend(wrong_direction(name, dependency));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    // runtime <- core <- io <- report <- tumble at least.
    assert!(edges >= 4, "only {edges} dependencies between members were seen");
}

#[test]
fn wrong_directions_are_told_from_right_ones() {
    assert_eq!(wrong_direction("tumble", "tumble-core"), None);
    assert_eq!(wrong_direction("tumble-pdf", "tumble-report"), None);
    assert!(wrong_direction("tumble-core", "tumble-io").is_some());
    assert!(wrong_direction("tumble-report", "tumble-pdf").is_some());
    assert!(wrong_direction("tumble-pdf", "tumble-bench").is_some());
    assert_eq!(layer("tumble-common"), None);
}

#[test]
fn the_code_that_flies_depends_on_nothing() {
    let all = dependencies(members()["tumble-runtime"], &[None, Some("build"), Some("dev")]);
    assert!(all.is_empty(), "tumble-runtime depends on {all:?}");
}

// --- licences ---

/// Why an expression is refused.
#[derive(Debug, PartialEq, Eq)]
enum Refusal {
    /// Nothing that may be chosen is allowed.
    NotAllowed,
    /// Not an expression of licences.
    Syntax,
}

/// Reads an SPDX licence expression (`OR`, `AND`, `WITH`, parentheses; `/` of old manifests is `OR`) and asks
/// for every licence whether it is allowed.
struct Expression<'a> {
    tokens: Vec<&'a str>,
    next: usize,
    allowed: &'a dyn Fn(&str) -> bool,
}

impl<'a> Expression<'a> {
    fn check(text: &'a str, allowed: &'a dyn Fn(&str) -> bool) -> Result<(), Refusal> {
        let mut expression = Self { tokens: tokens(text), next: 0, allowed };
        match expression.any() {
            Some(ok) if expression.next == expression.tokens.len() => {
                if ok {
                    Ok(())
                } else {
                    Err(Refusal::NotAllowed)
                }
            }
            _ => Err(Refusal::Syntax),
        }
    }

    fn take(&mut self, token: &str) -> bool {
        let found = self.tokens.get(self.next) == Some(&token);
        self.next += usize::from(found);
        found
    }

    /// `all OR all OR …`; AND binds more tightly.
    fn any(&mut self) -> Option<bool> {
        let mut value = self.all()?;
        while self.take("OR") || self.take("/") {
            value |= self.all()?;
        }
        Some(value)
    }

    /// `one AND one AND …`
    fn all(&mut self) -> Option<bool> {
        let mut value = self.one()?;
        while self.take("AND") {
            value &= self.one()?;
        }
        Some(value)
    }

    /// `( any )`, `licence` or `licence WITH exception`.
    fn one(&mut self) -> Option<bool> {
        if self.take("(") {
            let value = self.any()?;
            return self.take(")").then_some(value);
        }
        let licence = self.word()?;
        if self.take("WITH") {
            let exception = self.word()?;
            return Some((self.allowed)(&format!("{licence} WITH {exception}")));
        }
        Some((self.allowed)(licence))
    }

    fn word(&mut self) -> Option<&'a str> {
        let word = *self.tokens.get(self.next)?;
        let is_word = !matches!(word, "OR" | "AND" | "WITH" | "(" | ")" | "/");
        self.next += usize::from(is_word);
        is_word.then_some(word)
    }
}

fn tokens(text: &str) -> Vec<&str> {
    text.split_whitespace()
        .flat_map(|piece| piece.split_inclusive(['(', ')', '/']))
        .flat_map(|piece| match piece.char_indices().last() {
            Some((at, '(' | ')' | '/')) => [&piece[..at], &piece[at..]],
            _ => [piece, ""],
        })
        .filter(|token| !token.is_empty())
        .collect()
}

fn is_allowed(package: &str, licence: &str) -> bool {
    ALLOWED.contains(&licence) || ALLOWED_FOR.contains(&(package, licence))
}

#[test]
fn licence_expressions_are_understood() {
    use Refusal::{NotAllowed, Syntax};
    for (package, expression, expected) in [
        ("x", "MIT", Ok(())),
        ("x", "MIT OR Apache-2.0", Ok(())),
        ("x", "MIT/Apache-2.0", Ok(())),
        ("x", "MIT / GPL-3.0", Ok(())),
        ("x", "GPL-3.0/MIT", Ok(())),
        ("x", "(MIT OR Apache-2.0) AND Unicode-3.0", Ok(())),
        ("x", "MIT OR Apache-2.0 OR LGPL-2.1-or-later", Ok(())),
        ("x", "Apache-2.0 WITH LLVM-exception", Ok(())),
        ("x", "Apache-2.0 WITH LLVM-exception OR Apache-2.0 OR MIT", Ok(())),
        ("x", "((MIT))", Ok(())),
        ("x", "MIT OR GPL-3.0 AND LGPL-3.0", Ok(())),
        ("serialport", "MPL-2.0", Ok(())),
        ("x", "GPL-3.0", Err(NotAllowed)),
        ("x", "GPL-3.0-only OR AGPL-3.0", Err(NotAllowed)),
        ("x", "MIT AND GPL-3.0", Err(NotAllowed)),
        ("x", "GPL-3.0 AND MIT", Err(NotAllowed)),
        ("x", "(MIT OR GPL-3.0) AND GPL-3.0", Err(NotAllowed)),
        ("x", "(MIT OR Apache-2.0) AND LGPL-2.1", Err(NotAllowed)),
        ("x", "GPL-2.0 WITH LLVM-exception", Err(NotAllowed)),
        ("x", "MIT WITH LLVM-exception", Err(NotAllowed)),
        ("x", "MPL-2.0", Err(NotAllowed)),
        ("x", "MIT-0", Err(NotAllowed)),
        ("x", "mit", Err(NotAllowed)),
        ("x", "LicenseRef-own", Err(NotAllowed)),
        ("x", "", Err(Syntax)),
        ("x", "MIT OR", Err(Syntax)),
        ("x", "OR MIT", Err(Syntax)),
        ("x", "MIT Apache-2.0", Err(Syntax)),
        ("x", "(MIT", Err(Syntax)),
        ("x", "MIT)", Err(Syntax)),
        ("x", "MIT OR (Apache-2.0", Err(Syntax)),
        ("x", "MIT WITH", Err(Syntax)),
        ("x", "()", Err(Syntax)),
    ] {
        let allowed = |licence: &str| is_allowed(package, licence);
        assert_eq!(Expression::check(expression, &allowed), expected, "{package}: `{expression}`");
    }
}

#[test]
fn every_package_has_an_allowed_licence() {
    let nodes: BTreeSet<&str> =
        list(&metadata()["resolve"], "nodes").iter().map(|n| text(n, "id")).collect();
    let packages: Vec<&Value> =
        list(metadata(), "packages").iter().filter(|p| nodes.contains(text(p, "id"))).collect();
    assert!(packages.len() > FEWEST_PACKAGES, "only {} packages in the graph", packages.len());
    assert_eq!(packages.len(), nodes.len(), "every node of the graph is a package");
    let refused: Vec<String> = packages
        .iter()
        .filter_map(|p| {
            let name = text(p, "name");
            let licence = p["license"].as_str().unwrap_or_default();
            let refusal = Expression::check(licence, &|l| is_allowed(name, l)).err()?;
            Some(format!("{name} {}: licence `{licence}`: {refusal:?}", text(p, "version")))
        })
        .collect();
    assert!(refused.is_empty(), "{refused:#?}");
}

// --- what each crate says about itself ---

#[test]
fn every_member_says_what_it_is() {
    let members = members();
    assert!(members.len() >= 5, "only {} members", members.len());
    let mut descriptions = BTreeSet::new();
    for (name, package) in members {
        assert_eq!(package["license"], "MIT OR Apache-2.0", "licence of {name}");
        let description = package["description"].as_str().unwrap_or_default().trim();
        assert!(description.len() >= 20, "{name} has no description: `{description}`");
        assert!(descriptions.insert(description), "{name} has the description of another crate");
        let rust = package["rust_version"].as_str().unwrap_or_default();
        let is_version = rust.split('.').count() >= 2
            && rust.split('.').all(|n| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()));
        assert!(is_version, "{name} names no rust-version: `{rust}`");
    }
}
