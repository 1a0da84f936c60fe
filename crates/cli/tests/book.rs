//! The pages of docs/site: every case in them is read, every command run, every output compared.
//!
//! A page's `console` blocks run from its top to its end in a folder of its own. A line `$ frfit …` is run, and must end with exit code 0; the lines below
//! it, if there are any, are what it says, where `…` stands for any text in a line, and a line `…` for any lines. A `toml` block is read as a case or a part of one.
//! Comments that a reader does not see say more: `<!-- exit 1 -->` before a block, which exit code its last command has; `<!-- file NAME -->`, that a `toml` block
//! is that file; `<!-- file NAME after BASE -->`, that it stands in place of all from `[identify]` on in BASE; `<!-- copy NAME TO -->`, a file of docs/site/data;
//! `<!-- picture FIGURE NAME -->`, a figure that was just made and is docs/site/src/images/NAME: `FRFIT_RENEW=1 cargo test -p frfit-cli --test book` renews all of them.

use crate::common;

use crate::tier::is_long;
use common::frfit;
use std::fmt::Write;
use std::path::{Path, PathBuf};

fn site() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/site")
}

/// The Markdown files of the site, by name.
fn pages() -> Vec<(String, String)> {
    let files = std::fs::read_dir(site().join("src")).unwrap().map(|entry| entry.unwrap().path());
    let pages = files.filter(|path| path.extension().is_some_and(|ending| ending == "md"));
    let page = |path: PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, std::fs::read_to_string(path).unwrap().replace("\r\n", "\n"))
    };
    let mut pages: Vec<_> = pages.map(page).collect();
    pages.sort();
    pages
}

/// What a page has to say to this test, in order.
#[derive(Debug, PartialEq)]
enum Part<'a> {
    /// The words of a comment.
    Comment(&'a str),
    /// A block of code: the line where it begins, its language, its lines.
    Code(usize, &'a str, Vec<&'a str>),
}

fn parts(page: &str) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    let mut lines = page.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        if let Some(language) = line.trim_start().strip_prefix("```") {
            let code = lines.by_ref().map(|(_, line)| line).take_while(|line| line.trim() != "```").collect();
            parts.push(Part::Code(number + 1, language, code));
        } else if let Some(comment) = line.strip_prefix("<!-- ").and_then(|rest| rest.strip_suffix(" -->")) {
            parts.push(Part::Comment(comment));
        }
    }
    parts
}

/// Whether a line is the expected one, in which … is any text.
fn same(expected: &str, said: &str) -> bool {
    match expected.split_once('…') {
        None => expected == said,
        Some((before, after)) => said.strip_prefix(before).is_some_and(|rest| {
            let starts = rest.char_indices().map(|(at, _)| at).chain([rest.len()]);
            starts.into_iter().any(|at| same(after, &rest[at..]))
        }),
    }
}

/// Whether lines are the expected ones, in which a line … is any number of lines.
fn all_same(expected: &[&str], said: &[&str]) -> bool {
    match (expected.split_first(), said.split_first()) {
        (None, None) => true,
        (Some((first, rest)), _) if first.trim() == "…" => {
            (0..=said.len()).any(|skip| all_same(rest, &said[skip..]))
        }
        (Some((first, rest)), Some((line, more))) => same(first, line) && all_same(rest, more),
        _ => false,
    }
}

/// Runs the commands of a block, and compares what they say.
fn run(folder: &Path, lines: &[&str], last_exit: i32) -> Result<(), String> {
    let starts: Vec<usize> = (0..lines.len()).filter(|&at| lines[at].starts_with("$ ")).collect();
    if starts.first() != Some(&0) {
        return Err("expected a block that begins with a command \"$ frfit …\"".into());
    }
    for (k, &start) in starts.iter().enumerate() {
        let end = starts.get(k + 1).copied().unwrap_or(lines.len());
        let command = lines[start];
        let words = command.strip_prefix("$ frfit ").ok_or(format!("{command}: only frfit is run here"))?;
        if words.contains(['"', '\'', '|', '>', '&', ';', '*']) {
            return Err(format!("{command}: no shell reads this"));
        }
        let output = frfit(folder, &words.split_whitespace().collect::<Vec<_>>());
        let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
        let exit = if k + 1 == starts.len() { last_exit } else { 0 };
        if output.status.code() != Some(exit) {
            return Err(format!(
                "{command}: expected exit code {exit}, found {:?}:\n{text}",
                output.status.code()
            ));
        }
        let expected: Vec<&str> = lines[start + 1..end].iter().map(|line| line.trim_end()).collect();
        let expected = expected.strip_suffix(&[""]).unwrap_or(&expected);
        let said: Vec<&str> = text.lines().map(str::trim_end).collect();
        if !expected.is_empty() && !all_same(expected, &said) {
            return Err(format!("{command}: expected\n{}\nfound\n{text}", expected.join("\n")));
        }
    }
    Ok(())
}

/// Tables that a part of a case leaves out, so that it can be read.
const REST: [(&str, &str); 3] = [
    ("[[matrix]]", "[[matrix]]\nname = \"rest\"\nrole = \"mass\"\nfile = \"M.mtx\"\n"),
    ("[load]", "[load]\nrow = 1\n"),
    ("[[measurement]]", "[[measurement]]\nrow = 1\n"),
];

fn read_case(text: &str) -> Result<(), String> {
    let mut whole = text.to_owned();
    for (header, table) in REST {
        if !text.contains(header) {
            whole += table;
        }
    }
    let case = frfit_workflow::case::parse(Path::new("case.toml"), whole.as_bytes());
    case.map(drop).map_err(|error| error.to_string())
}

/// A figure that was just made is there, and so is the picture of the page, small enough for a page; renewed if that is asked for.
fn picture(figure: &Path, name: &str) -> Result<(), String> {
    const LARGEST: u64 = 150_000;
    let made = std::fs::metadata(figure).map_err(|error| format!("{}: {error}", figure.display()))?;
    let picture = site().join("src/images").join(name);
    if std::env::var_os("FRFIT_RENEW").is_some() {
        std::fs::copy(figure, &picture).map_err(|error| format!("{}: {error}", picture.display()))?;
    }
    let there = std::fs::metadata(&picture).map_err(|error| format!("{}: {error}", picture.display()))?;
    match made.len().max(there.len()) {
        ..=LARGEST => Ok(()),
        bytes => Err(format!("{name}: expected at most {LARGEST} bytes, found {bytes}")),
    }
}

/// Does all that a page says, or only reads the cases in it.
fn follow(page: &str, is_run: bool) -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let inside = |name: &str| folder.path().join(name);
    let (mut exit, mut file) = (0, None);
    for part in parts(page) {
        match part {
            Part::Comment(_) | Part::Code(_, "console", _) if !is_run => {}
            Part::Comment(comment) => match comment.split_whitespace().collect::<Vec<_>>()[..] {
                ["exit", code] => exit = code.parse().map_err(|_| format!("<!-- {comment} -->"))?,
                ["file", name] => file = Some((name, None)),
                ["file", name, "after", base] => file = Some((name, Some(base))),
                ["copy", name, to] => {
                    let from = site().join("data").join(name);
                    std::fs::copy(&from, inside(to))
                        .map_err(|error| format!("{}: {error}", from.display()))?;
                }
                ["picture", figure, name] => picture(&inside(figure), name)?,
                _ => return Err(format!("<!-- {comment} -->: expected exit, file, copy or picture")),
            },
            Part::Code(line, language, code) => {
                let here = |error: String| format!("line {line}: {error}");
                match language {
                    "console" => run(folder.path(), &code, exit).map_err(here)?,
                    "toml" => {
                        let text = code.join("\n") + "\n";
                        read_case(&text).map_err(here)?;
                        if let Some((name, base)) = file {
                            let base =
                                base.map_or(Ok(String::new()), |base| std::fs::read_to_string(inside(base)));
                            let base = base.map_err(|error| here(error.to_string()))?;
                            let before = base.split("[identify]").next().unwrap_or_default();
                            std::fs::write(inside(name), format!("{before}{text}"))
                                .map_err(|error| here(error.to_string()))?;
                        }
                    }
                    // Those of Python are run by crates/python/tests/test_site.py, those of Rust by crates/examples as doc tests.
                    "python" | "rust" => {}
                    "sh" | "text" if !code.iter().any(|line| line.trim_start().starts_with("frfit")) => {}
                    _ => return Err(here(format!("```{language}: no test looks at such a block"))),
                }
                (exit, file) = (0, None);
            }
        }
    }
    Ok(())
}

/// Pages whose commands take three quarters of the time, and of which other tests run the like: only their cases are read by day.
const LONG: [&str; 11] = [
    "batch.md",
    "comparison.md",
    "gallery.md",
    "grey.md",
    "hammer.md",
    "meshes.md",
    "modes.md",
    "nastran.md",
    "sensors.md",
    "several.md",
    "wooden-plate.md",
];

#[test]
fn every_page_does_what_it_says() {
    let pages = pages();
    let is_run = |name: &str| is_long() || !LONG.contains(&name);
    assert!(LONG.iter().all(|long| pages.iter().any(|(name, _)| name == long)), "{LONG:?}");
    let mut faults = String::new();
    std::thread::scope(|scope| {
        let running: Vec<_> =
            pages.iter().map(|(name, page)| (name, scope.spawn(|| follow(page, is_run(name))))).collect();
        for (name, one) in running {
            if let Err(fault) = one.join().unwrap() {
                let _ = writeln!(faults, "{name}: {fault}");
            }
        }
    });
    assert!(faults.is_empty(), "{faults}");
}

#[test]
fn every_page_is_in_the_summary() {
    let pages = pages();
    let (_, summary) = pages.iter().find(|(name, _)| name == "SUMMARY.md").unwrap();
    for (name, page) in &pages {
        assert!(
            name == "SUMMARY.md" || summary.contains(&format!("({name})")),
            "{name} is not in SUMMARY.md"
        );
        assert!(page.starts_with("# "), "{name} has no title");
        // Doc tests of crates/examples take in this page alone.
        assert!(name == "library.md" || !page.contains("```rust"), "{name} has Rust that nothing compiles");
    }
}

/// What the other tests rest on.
#[test]
fn faults_are_found() {
    for (page, fault) in [
        ("```console\n$ frfit nonsense\n```\n", "expected exit code 0, found Some(2)"),
        ("```console\n$ frfit example\nwrong\n```\n", "expected\nwrong\nfound\nrubber-bar "),
        ("```console\n$ ls\n```\n", "only frfit is run here"),
        ("```console\nfrfit demo\n```\n", "expected a block that begins with a command"),
        ("<!-- exit 1 -->\n```console\n$ frfit example\n```\n", "expected exit code 1, found Some(0)"),
        ("```toml\n[identify]\nmatrx = \"plate\"\n```\n", "\"matrix\" is nearest"),
        ("```sh\nfrfit demo\n```\n", "no test looks at such a block"),
        ("```bash\nls\n```\n", "no test looks at such a block"),
        ("<!-- nonsense -->\n", "expected exit, file, copy or picture"),
    ] {
        let found = follow(page, true).expect_err(page);
        assert!(found.contains(fault), "{found}");
    }
    assert!(follow("```toml\n[identify]\nmatrx = \"plate\"\n```\n", false).is_err());
    assert!(same("a … c", "a b b c") && same("…", "") && !same("a …c", "a b") && !same("a", "ab"));
    assert!(all_same(&["a", "…", "c…"], &["a", "b", "b", "cd"]) && all_same(&["…"], &[]));
    assert!(!all_same(&["a", "…"], &["b"]) && !all_same(&["a"], &["a", "b"]));
}

/// All Markdown that a reader of the repository or of the site sees.
fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = ["", "docs", "docs/site/src", "crates/python", "crates/multifrontal"];
    let files = folders.map(|folder| std::fs::read_dir(root.join(folder)).unwrap());
    let paths = files.into_iter().flatten().map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect()
}

/// Headings as GitHub and mdBook make places of them.
fn places(page: &str) -> Vec<String> {
    let mut is_code = false;
    let headings = page.lines().filter(|line| {
        is_code ^= line.trim_start().starts_with("```");
        !is_code && line.starts_with('#')
    });
    let place = |heading: &str| {
        let text = heading.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        text.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect()
    };
    headings.map(place).collect()
}

/// The links of a document that lead nowhere.
fn lost_links(path: &Path, page: &str) -> Vec<String> {
    let prose: String = parts_of_prose(page);
    let links = prose.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0));
    let is_lost = |link: &&str| {
        if link.contains("://") || link.starts_with("mailto:") {
            return false;
        }
        let (file, place) = link.split_once('#').map_or((*link, None), |(file, place)| (file, Some(place)));
        let to = if file.is_empty() { path.to_owned() } else { path.with_file_name(file) };
        let Some(place) = place else { return !to.exists() };
        let text = if file.is_empty() { Ok(page.to_owned()) } else { std::fs::read_to_string(&to) };
        !text.is_ok_and(|text| places(&text).iter().any(|known| known == place))
    };
    links.filter(is_lost).map(|link| format!("{}: {link}", path.display())).collect()
}

/// A document without its code.
fn parts_of_prose(page: &str) -> String {
    let mut is_code = false;
    let lines = page.lines().filter(|line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    });
    // Of a line the odd pieces between backticks are code.
    let prose = lines.map(|line| line.split('`').step_by(2).collect::<Vec<_>>().join("code"));
    prose.collect::<Vec<_>>().join("\n")
}

/// The site's own check, of pages as mdBook builds them, is in the long tier.
#[test]
fn every_link_of_the_sources_leads_somewhere() {
    let documents = documents();
    assert!(documents.len() > 20, "{documents:?}");
    let lost = documents.iter().flat_map(|path| lost_links(path, &std::fs::read_to_string(path).unwrap()));
    let lost: Vec<String> = lost.collect();
    assert!(lost.is_empty(), "{lost:#?}");
    let here = Path::new("here.md");
    let page = "# A title, too\n[a](#a-title-too) `[b](b.md)` [c](https://c.org)\n```\n[d](d.md)\n```\n";
    assert_eq!(lost_links(here, page), Vec::<String>::new());
    assert_eq!(lost_links(here, "# A\n[a](#b) [b](missing.md)"), ["here.md: #b", "here.md: missing.md"]);
}

/// README and the page on statuses have each of them, and no other.
#[test]
fn every_status_is_explained() {
    let names: Vec<&str> = frfit::identify::Status::ALL.iter().map(|status| status.name()).collect();
    // What the user left out needs no explanation in the README, and what is fine none on the page of what is not.
    for (page, left_out) in [("../../README.md", "out_of_band"), ("src/grey.md", "ok")] {
        let text = std::fs::read_to_string(site().join(page)).unwrap();
        let table = text.split("| status |").nth(1).unwrap().split("\n\n").next().unwrap();
        let rows: Vec<&str> =
            table.lines().filter_map(|row| row.strip_prefix("| `")?.split('`').next()).collect();
        for name in &names {
            assert!(rows.contains(name) || *name == left_out, "{page}: {name} is not in {rows:?}");
        }
        assert!(rows.iter().all(|row| names.contains(row)), "{page}: {rows:?}");
    }
}
