//! The rules for Markdown: the words, lines of at most 100 characters, one sentence a line, sentences of at most 40 words.

use super::{Fault, words};

/// Characters of a line. Code, tables, links, headings, formulas on lines of their own and comments may be longer.
const LONGEST_LINE: usize = 100;

/// Words of a sentence.
const LONGEST_SENTENCE: usize = 40;

/// What ends with a full stop and ends no sentence, beside single letters.
const ABBREVIATIONS: [&str; 16] = [
    "Acoust", "Am", "Eq", "Eqs", "Fig", "Figs", "No", "Sec", "Soc", "al", "approx", "cf", "e.g", "i.e", "pp",
    "vs",
];

/// What a line is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Code, a formula on lines of its own, or a comment.
    Other,
    Empty,
    Heading,
    Table,
    /// The first line of an item of a list.
    Item,
    Text,
}

/// All faults of a page, in the order of its lines.
pub(super) fn faults(page: &str) -> Vec<Fault> {
    let lines: Vec<(Kind, &str)> = kinds(page).into_iter().zip(page.lines()).collect();
    // One line for each of the page, so that the numbers of lines stay.
    let prose: Vec<String> = lines
        .iter()
        .map(|&(kind, line)| if kind == Kind::Other { String::new() } else { without_code(line) })
        .collect();
    let mut faults = words::faults(&prose.join("\n"));
    for (number, (&(kind, line), prose)) in (1..).zip(lines.iter().zip(&prose)) {
        if !matches!(kind, Kind::Text | Kind::Item) {
            continue;
        }
        let length = line.chars().count();
        let has_link = line.contains("](") || line.contains("://");
        if length > LONGEST_LINE && !has_link {
            faults.push(Fault {
                line: number,
                what: format!("{length} characters"),
                suggestion: format!("at most {LONGEST_LINE}"),
            });
        }
        if ends(prose).iter().any(|&end| !prose[end..].trim().is_empty()) {
            faults.push(Fault {
                line: number,
                what: "two sentences".into(),
                suggestion: "one sentence a line".into(),
            });
        }
    }
    faults.extend(long_sentences(&lines, &prose));
    faults.sort_by_key(|fault| fault.line);
    faults
}

fn long_sentences(lines: &[(Kind, &str)], prose: &[String]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let (mut begin, mut count) = (1, 0);
    let mut close = |begin: usize, count: &mut usize| {
        if *count > LONGEST_SENTENCE {
            faults.push(Fault {
                line: begin,
                what: format!("a sentence of {count} words"),
                suggestion: format!("at most {LONGEST_SENTENCE}: make two of it"),
            });
        }
        *count = 0;
    };
    for (number, (&(kind, _), prose)) in (1..).zip(lines.iter().zip(prose)) {
        if kind != Kind::Text {
            close(begin, &mut count);
        }
        if !matches!(kind, Kind::Text | Kind::Item) {
            continue;
        }
        let mut from = 0;
        for end in ends(prose).into_iter().chain([prose.len()]) {
            if count == 0 {
                begin = number;
            }
            let is_word = |word: &&str| word.contains(char::is_alphanumeric);
            count += prose[from..end].split_whitespace().filter(is_word).count();
            if end < prose.len() || unquoted(prose.trim_end()).ends_with(['.', '!', '?', ':']) {
                close(begin, &mut count);
            }
            from = end;
        }
    }
    close(begin, &mut count);
    faults
}

/// What each line of a page is.
fn kinds(page: &str) -> Vec<Kind> {
    let (mut is_code, mut is_formula, mut is_comment) = (false, false, false);
    let mut before = Kind::Empty;
    let mut was_indented = false;
    let of_line = |line: &str| {
        let text = line.trim();
        let is_fence = text.starts_with("```");
        // Four spaces make code, unless a paragraph or an item goes on.
        let is_indented = line.starts_with("    ") && (before == Kind::Empty || was_indented);
        let is_delimiter = text.matches("$$").count() == 1;
        let kind = if is_fence || is_code || is_formula || is_comment || is_delimiter {
            Kind::Other
        } else if text.is_empty() {
            Kind::Empty
        } else if is_indented || text.starts_with("$$") || text.starts_with("<!--") {
            Kind::Other
        } else if text.starts_with('#') {
            Kind::Heading
        } else if text.starts_with('|') {
            Kind::Table
        } else if is_item(text) {
            Kind::Item
        } else {
            Kind::Text
        };
        is_code ^= is_fence;
        is_formula ^= is_delimiter && !is_code;
        is_comment = (is_comment || text.starts_with("<!--")) && !text.contains("-->");
        was_indented = kind == Kind::Other && is_indented;
        before = kind;
        kind
    };
    page.lines().map(of_line).collect()
}

/// Whether a line begins with `- `, `* `, or a number as `1. `.
fn is_item(text: &str) -> bool {
    let digits = text.trim_start_matches(|c: char| c.is_ascii_digit());
    text.starts_with("- ") || text.starts_with("* ") || digits.len() < text.len() && digits.starts_with(". ")
}

/// A line with one word for each piece of code and each formula, and without addresses of links.
fn without_code(line: &str) -> String {
    let mut prose = String::new();
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        let mark = if rest.starts_with("](") { "](" } else { &rest[..first.len_utf8()] };
        let (end, stands) = match mark {
            "`" => ("`", "Code"),
            "$" => ("$", "Formula"),
            "](" => (")", ""),
            _ => {
                prose.push(first);
                rest = &rest[mark.len()..];
                continue;
            }
        };
        match rest[mark.len()..].split_once(end) {
            Some((_, after)) => {
                prose.push_str(stands);
                rest = after;
            }
            // A mark without its partner is a character as any other.
            None => {
                prose.push_str(mark);
                rest = &rest[mark.len()..];
            }
        }
    }
    prose
}

/// The ends of the sentences within a line that another one follows.
fn ends(prose: &str) -> Vec<usize> {
    let stops = prose.char_indices().filter(|(_, c)| ".!?".contains(*c)).map(|(at, _)| at + 1);
    stops.filter(|&end| ends_sentence(&prose[..end]) && begins_sentence(&prose[end..])).collect()
}

/// Whether a sentence begins after a full stop. One may begin with code, or with the name of the program.
fn begins_sentence(after: &str) -> bool {
    let text = after.trim_start_matches(['"', '”', ')', '*', ']']);
    let next = text.trim_start().trim_start_matches(['"', '“', '(', '*', '[']);
    text.starts_with(' ') && (next.starts_with(char::is_uppercase) || next.starts_with("frfit "))
}

/// A text without the quotes and brackets at its end.
fn unquoted(text: &str) -> &str {
    text.trim_end_matches(['"', '”', ')', '*', ']'])
}

/// Whether a text within a line ends a sentence. The end of a line after a full stop always does.
fn ends_sentence(text: &str) -> bool {
    let text = unquoted(text);
    let Some(before) = text.strip_suffix('.') else { return text.ends_with(['!', '?']) };
    let word = before.rsplit(|c: char| c.is_whitespace() || "([".contains(c)).next().unwrap_or_default();
    let is_initial = word.chars().count() == 1 && word.chars().all(char::is_uppercase);
    // The number of an item is no sentence.
    let is_number = before.trim_start() == word && word.chars().all(|c| c.is_ascii_digit());
    !is_initial && !is_number && !ABBREVIATIONS.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(page: &str) -> Vec<String> {
        faults(page).iter().map(|fault| format!("{}: {}", fault.line, fault.what)).collect()
    }

    const NONE: [&str; 0] = [];

    #[test]
    fn a_good_page_has_no_faults() {
        let page = "# Title. With two. Sentences\n\nA sentence with `code. More` and $x. Y$.\nAnother one,\non two lines.\n\n\
                    - **Item.**\n  Its text, e.g. This.\n1. One.\n2. Two.\n\n| a. B. C | told apart? |\n";
        assert_eq!(found(page), ["12: told"]);
    }

    #[test]
    fn code_formulas_and_comments_are_left_out() {
        let long = "told ".repeat(30);
        for page in [
            format!("```text\n{long}\n```\n"),
            format!("    {long}\n"),
            format!("Text.\n\n      {long}\n      {long}\n"),
            format!("$$ {long} $$\n"),
            format!("$$\n{long}\n$$\n"),
            format!("<!-- {long} -->\n"),
            format!("<!--\n{long}\n-->\n"),
        ] {
            assert_eq!(found(&page), NONE, "{page}");
        }
        assert_eq!(found("`told` [text](told.md)\n"), NONE);
    }

    #[test]
    fn a_line_after_code_is_prose_again() {
        for code in ["```text\ncode\n```\n", "$$\nx\n$$\n", "<!--\ncomment\n-->\n", "\n    code\n"] {
            let page = format!("{code}told\n");
            assert_eq!(found(&page), [format!("{}: told", page.lines().count())], "{page}");
        }
    }

    #[test]
    fn long_lines_are_found() {
        let long = "ab ".repeat(34);
        assert_eq!(found(&long), ["1: 102 characters"]);
        assert_eq!(found(&format!("ä{}", "ab ".repeat(33))), NONE);
        assert_eq!(found(&format!("- {long}")), ["1: 104 characters"]);
        for exempt in [
            format!("# {long}"),
            format!("| {long} |"),
            format!("[a](b.md) {long}"),
            format!("https://a.b {long}"),
        ] {
            assert_eq!(found(&exempt), NONE, "{exempt}");
        }
    }

    #[test]
    fn two_sentences_on_a_line_are_found() {
        for line in [
            "One. Two.",
            "One? Two.",
            "One (so). Two.",
            "**One.** Two.",
            "One. `code` two.",
            "One. $x$ two.",
            "- One. Two.",
            "1. One. Two.",
            "In `code`. Two.",
            "One. frfit two.",
            "One.\" \"Two.",
        ] {
            assert_eq!(found(line), ["1: two sentences"], "{line}");
        }
        for line in [
            "D. G. Name and F. Name, J. Acoust. Soc. Am. 154",
            "See Fig. 5.",
            "1. One.",
            "a.b. c",
            "UFF 58/58b, v1.2 Two",
        ] {
            assert_eq!(found(line), NONE, "{line}");
        }
    }

    #[test]
    fn long_sentences_are_found_where_they_begin() {
        let words = |count: usize| vec!["word"; count].join(" ");
        let lines = |count: usize| vec![words(10); count].join("\n");
        assert_eq!(found(&format!("Short.\n{}\nand more.\n", lines(4))), ["2: a sentence of 42 words"]);
        assert_eq!(found(&format!("{}.\n", lines(4))), NONE);
        for end in [".", ":", "?", " E.", ".)", "\n", "\n- item", "\n| table |", "\n# heading"] {
            assert_eq!(found(&format!("{}{end}\n{}\n", lines(3), lines(3))), NONE, "{end}");
        }
        // Code and formulas count as a word each, and signs as none.
        assert_eq!(found(&format!("{}\n`a b c d` $e f g h$ – = +\n", lines(3))), NONE);
    }
}
