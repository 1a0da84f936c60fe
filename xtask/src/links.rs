//! The links of built HTML pages: every one within the site leads to a page, and to a place in it, that is there.
//!
//! Addresses of the network are not followed, only looked at; what a page loads must not be one.

use crate::step::Step;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};
use std::time::Instant;

/// Checks all pages in a folder.
pub(crate) fn check(folder: &Path) -> Step {
    println!("── links");
    let start = Instant::now();
    let faults = faults(folder).unwrap_or_else(|error| vec![format!("{}: {error}", folder.display())]);
    faults.iter().for_each(|fault| eprintln!("{fault}"));
    Step {
        name: "links",
        seconds: start.elapsed().as_secs_f64(),
        passed: faults.is_empty(),
        closing: Vec::new(),
    }
}

/// What is wrong, a line each.
fn faults(folder: &Path) -> std::io::Result<Vec<String>> {
    let mut pages = BTreeMap::new();
    read(folder, Path::new(""), &mut pages)?;
    let names: BTreeMap<&Path, BTreeSet<String>> =
        pages.iter().map(|(page, html)| (page.as_path(), of(html, &["id", "name"]).collect())).collect();
    let mut faults = Vec::new();
    if pages.is_empty() {
        faults.push(format!("{}: no page", folder.display()));
    }
    for (page, html) in &pages {
        let mut fault = |link: &str, what: &str| faults.push(format!("{}: {link}: {what}", page.display()));
        for link in of(html, &["href"]) {
            if let Some(what) = lost(folder, page, &link, &names) {
                fault(&link, what);
            }
        }
        for source in of(html, &["src"]).chain(of_style_sheets(html)) {
            if is_outside(&source) {
                fault(&source, "a page has to load without a network");
            } else if let Some(what) = lost(folder, page, &source, &names) {
                fault(&source, what);
            }
        }
    }
    Ok(faults)
}

/// All HTML pages below a folder, by their paths in it.
fn read(folder: &Path, inside: &Path, pages: &mut BTreeMap<PathBuf, String>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder.join(inside))? {
        let entry = entry?;
        let path = inside.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            read(folder, &path, pages)?;
        } else if path.extension().is_some_and(|ending| ending == "html") {
            pages.insert(path, std::fs::read_to_string(entry.path())?);
        }
    }
    Ok(())
}

/// The values of these attributes in all tags. Scripts are left out: they may hold pieces of tags.
fn of<'a>(html: &'a str, names: &'a [&'a str]) -> impl Iterator<Item = String> + 'a {
    tags(html).flat_map(move |tag| names.iter().filter_map(move |name| attribute(tag, name)))
}

fn of_style_sheets(html: &str) -> impl Iterator<Item = String> + '_ {
    let sheets = tags(html).filter(|tag| tag.starts_with("link") && !tag.contains("rel=\"canonical\""));
    sheets.filter_map(|tag| attribute(tag, "href"))
}

/// What stands between < and > of each opening tag.
pub(crate) fn tags(html: &str) -> impl Iterator<Item = &str> {
    let mut rest = html;
    std::iter::from_fn(move || {
        let start = rest.find('<')? + 1;
        let tag = &rest[start..];
        if let Some(comment) = tag.strip_prefix("!--") {
            rest = comment.split_once("-->").map_or("", |(_, after)| after);
            return Some("");
        }
        let (tag, after) = tag.split_once('>')?;
        let is_script = tag == "script" || tag.starts_with("script ");
        rest = if is_script { after.split_once("</script>").map_or("", |(_, after)| after) } else { after };
        Some(tag)
    })
}

/// The value of an attribute in double quotes.
pub(crate) fn attribute(tag: &str, name: &str) -> Option<String> {
    let (_, value) = tag.split_once(&format!(" {name}=\""))?;
    let (value, _) = value.split_once('"')?;
    Some(value.replace("&amp;", "&"))
}

fn is_outside(link: &str) -> bool {
    link.starts_with("//") || link.contains("://")
}

/// What is wrong with a link; `None` where it leads somewhere, or is not followed.
fn lost(
    folder: &Path,
    page: &Path,
    link: &str,
    names: &BTreeMap<&Path, BTreeSet<String>>,
) -> Option<&'static str> {
    if is_outside(link) {
        let is_whole = link.strip_prefix("https://").or_else(|| link.strip_prefix("http://"));
        let host = is_whole.and_then(|rest| rest.split(['/', '?', '#']).next());
        let good = host.is_some_and(|host| host.contains('.') && !host.contains(char::is_whitespace));
        return (!good).then_some("no address of the network looks like this");
    }
    if link.starts_with("data:") || link.starts_with("mailto:") || link.starts_with("javascript:") {
        return None;
    }
    let (path, place) = link.split_once('#').map_or((link, None), |(path, place)| (path, Some(place)));
    let path = path.split('?').next().unwrap_or_default();
    let to = if path.is_empty() { page.to_path_buf() } else { below(page, path)? };
    if !folder.join(&to).is_file() {
        return Some("no such file");
    }
    let names = names.get(to.as_path())?;
    let there = place.is_none_or(|place| place.is_empty() || names.contains(&decoded(place)));
    (!there).then_some("no such place in that page")
}

/// A link from a page as a path in the site; `None` where it leads out of it.
fn below(page: &Path, link: &str) -> Option<PathBuf> {
    let link = decoded(link);
    let mut path = match link.strip_prefix('/') {
        Some(_) => PathBuf::new(),
        None => page.parent().unwrap_or(Path::new("")).to_path_buf(),
    };
    for part in Path::new(link.trim_start_matches('/')).components() {
        match part {
            Component::ParentDir if !path.pop() => return None,
            Component::ParentDir | Component::CurDir => {}
            part => path.push(part),
        }
    }
    if link.ends_with('/') {
        path.push("index.html");
    }
    Some(path)
}

/// A text with its %XX taken for what they stand for.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        match code.filter(|_| *first == b'%').and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is wrong with a page beside another one, which has the place "here", in a folder of this name.
    fn wrong(name: &str, link: &str) -> Vec<String> {
        let folder = std::env::temp_dir().join(format!("frfit-links-{}-{name}", std::process::id()));
        std::fs::create_dir_all(folder.join("inner")).unwrap();
        std::fs::write(folder.join("other.html"), "<h1 id=\"here\">Other</h1>").unwrap();
        std::fs::write(
            folder.join("inner/page.html"),
            format!("<h2 id=\"ρ\"></h2><!-- <a href=\"x\"> --><p>{link}</p>"),
        )
        .unwrap();
        let faults = faults(&folder).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        faults
    }

    #[test]
    fn links_that_lead_somewhere_are_left_alone() {
        let good = "<a href=\"../other.html\"></a><a class=\"c\" href=\"../other.html#here\"></a><a href=\"#%CF%81\"></a>\
                    <a href=\"https://doi.org/10.1115/1.4041217\"></a><img src=\"data:image/png;base64,AA\">\
                    <script>\"<a href='nowhere'>\" + '<a href=\"nowhere\">'</script>";
        assert_eq!(wrong("good", good), [""; 0]);
    }

    #[test]
    fn links_that_lead_nowhere_are_named() {
        for (k, (link, fault)) in [
            ("<a href=\"none.html\"></a>", "inner/page.html: none.html: no such file"),
            (
                "<a href=\"../other.html#there\"></a>",
                "inner/page.html: ../other.html#there: no such place in that page",
            ),
            ("<a href=\"#there\"></a>", "inner/page.html: #there: no such place in that page"),
            ("<img src=\"none.svg\">", "inner/page.html: none.svg: no such file"),
            (
                "<a href=\"https://nowhere\"></a>",
                "inner/page.html: https://nowhere: no address of the network looks like this",
            ),
            (
                "<script src=\"https://cdn.example.org/x.js\"></script>",
                "inner/page.html: https://cdn.example.org/x.js: a page has to load without a network",
            ),
            (
                "<link rel=\"stylesheet\" href=\"//example.org/x.css\">",
                "a page has to load without a network",
            ),
        ]
        .into_iter()
        .enumerate()
        {
            let found = wrong(&format!("bad{k}"), link);
            assert!(found.iter().any(|found| found.contains(fault)), "{link}: {found:?}");
        }
    }
}
