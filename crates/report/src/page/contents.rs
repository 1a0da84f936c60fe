//! The table of contents: the headings of the page, as links.

use std::fmt::Write;

/// The list of all parts, with the headings in them; `sections` is their HTML.
pub(super) fn contents(sections: &str) -> String {
    let mut html =
        "<nav id=\"contents\" aria-labelledby=\"contents-title\"><p id=\"contents-title\">Contents</p><ol>"
            .to_owned();
    let (mut is_first, mut has_inner) = (true, false);
    for (level, id, title) in headings(sections) {
        if level == 2 {
            html += if has_inner { "</ol>" } else { "" };
            html += if is_first { "" } else { "</li>" };
            // Writing to a string does not fail.
            let _ = write!(html, "<li><a href=\"#{id}\">{title}</a>");
            (is_first, has_inner) = (false, false);
        } else if !is_first {
            html += if has_inner { "" } else { "<ol>" };
            let _ = write!(html, "<li><a href=\"#{id}\">{title}</a></li>");
            has_inner = true;
        }
    }
    html += if has_inner { "</ol>" } else { "" };
    html += if is_first { "" } else { "</li>" };
    html + "</ol></nav>\n"
}

/// Level, id and text of each heading that has an id; those within a part that is folded away are left out.
fn headings(html: &str) -> impl Iterator<Item = (u8, &str, &str)> {
    let mut is_folded = false;
    html.match_indices("<h").filter_map(move |(at, _)| {
        let (before, rest) = (&html[..at], &html[at + 2..]);
        let level = match rest.as_bytes().first()? {
            b'2' => 2,
            b'3' => 3,
            _ => return None,
        };
        let (id, rest) = rest[1..].strip_prefix(" id=\"")?.split_once('"')?;
        let (_, rest) = rest.split_once('>')?;
        if level == 2 {
            is_folded = before.ends_with("<summary>");
        }
        (level == 2 || !is_folded).then_some((level, id, rest.split_once("</h")?.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_with_an_id_are_listed_in_their_order_and_nested() {
        let html = "<h2 id=\"a\" class=\"x\">A &amp; B</h2><h3>no id</h3><h3 id=\"b\">C</h3><h3 id=\"c\">D</h3><hr>\
                    <summary><h2 id=\"d\">E</h2></summary><h3 id=\"e\">F</h3>";
        let list = contents(html);
        let items = "<ol><li><a href=\"#a\">A &amp; B</a><ol><li><a href=\"#b\">C</a></li><li><a href=\"#c\">D</a></li></ol></li>\
                     <li><a href=\"#d\">E</a></li></ol>";
        assert!(list.contains(items), "{list}");
        assert!(contents("").ends_with("<ol></ol></nav>\n"));
    }
}
