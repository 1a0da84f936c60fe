//! Words that are refused, each with a suggestion.

use super::Fault;

/// A word or some words, and what to write.
type Entry = (&'static str, &'static str);

/// Words in lower case. Each is matched as whole words, across lines, and not across punctuation.
const LIST: [Entry; 47] = [
    // Words that stand for a noun or a verb of the field.
    ("told", "identifiable, known, given, stated"),
    ("tells", "shows, gives, states"),
    ("tell", "show, give, state; of two things: distinguish"),
    ("what nothing", "name the noun: \"no … does\""),
    ("that which", "name the noun"),
    ("what is left", "the misfit, the residual, the rest"),
    ("what is there", "name the noun"),
    ("is none", "there is no …"),
    ("are none", "there are no …"),
    ("is other", "differs"),
    ("such a", "this …, or: a … like this"),
    ("such an", "this …, or: an … like this"),
    ("one of each", "name both"),
    ("so many times", "by a factor of …"),
    ("by itself", "alone, independently, separately"),
    ("by themselves", "alone, independently, separately"),
    ("looked for", "searched, search for"),
    ("taken out", "corrected for, removed"),
    ("goes with", "is proportional to, belongs to"),
    ("hangs together", "is correlated"),
    ("hang together", "are correlated"),
    ("swallows", "absorbs"),
    ("is for who", "is for those who"),
    // Headings of tables.
    ("if it is not there", "Default"),
    ("what it says", "Description"),
    ("what it means", "Meaning"),
    ("what is in it", "Contents"),
    ("what to do", "Remedy"),
    ("what helps", "Remedy"),
    // Words that are out of use.
    ("it were", "it would be"),
    ("as ever", "as in every …"),
    ("anew", "again"),
    ("lest", "so that … not"),
    ("ere", "before"),
    ("whence", "from which"),
    ("hitherto", "until now"),
    ("thereof", "of the …"),
    ("therein", "in the …"),
    ("wherein", "in which"),
    ("aforementioned", "name the noun"),
    // Words that say nothing.
    ("in order to", "to"),
    ("due to the fact that", "because"),
    ("of course", "leave it out"),
    ("obviously", "leave it out"),
    ("simply", "leave it out"),
    ("utilise", "use"),
    ("utilize", "use"),
];

/// Terms of the field and headings in which a listed word stands rightly.
const ALLOWED: [&str; 2] = ["simply supported", "what to do first"];

/// Places of the listed words in a text without its code, in the order of the text.
pub(super) fn faults(prose: &str) -> Vec<Fault> {
    let tokens = tokens(prose);
    let mut faults = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if let Some(term) = ALLOWED.iter().find(|term| is_at(&tokens[at..], term)) {
            at += term.split(' ').count();
            continue;
        }
        let begins = |(phrase, _): &&Entry| is_at(&tokens[at..], phrase);
        // Of two entries that begin here the longer one says more.
        match LIST.iter().filter(begins).max_by_key(|(phrase, _)| phrase.len()) {
            Some((phrase, suggestion)) => {
                let (what, suggestion) = ((*phrase).to_owned(), (*suggestion).to_owned());
                faults.push(Fault { line: tokens[at].line, what, suggestion });
                at += phrase.split(' ').count();
            }
            None => at += 1,
        }
    }
    faults
}

/// A word in lower case, or punctuation: an empty one.
struct Token {
    line: usize,
    word: String,
}

fn is_at(tokens: &[Token], phrase: &str) -> bool {
    let mut tokens = tokens.iter();
    phrase.split(' ').all(|word| tokens.next().is_some_and(|token| token.word == word))
}

fn tokens(prose: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut is_empty = false;
    for (line, text) in (1..).zip(prose.lines()) {
        // A paragraph ends at an empty line.
        if text.trim().is_empty() && !is_empty {
            tokens.push(Token { line, word: String::new() });
        }
        is_empty = text.trim().is_empty();
        let mut rest = text;
        while let Some(first) = rest.chars().next() {
            let is_of_word = |c: char| c.is_alphanumeric() || "'’-_".contains(c);
            let end = rest.find(|c| !is_of_word(c)).unwrap_or(rest.len());
            if end > 0 {
                tokens.push(Token { line, word: rest[..end].to_lowercase() });
                rest = &rest[end..];
            } else {
                // Emphasis is no punctuation.
                if !first.is_whitespace() && first != '*' {
                    tokens.push(Token { line, word: String::new() });
                }
                rest = &rest[first.len_utf8()..];
            }
        }
    }
    tokens
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(prose: &str) -> Vec<(usize, String)> {
        faults(prose).into_iter().map(|fault| (fault.line, fault.what)).collect()
    }

    fn one(line: usize, what: &str) -> Vec<(usize, String)> {
        vec![(line, what.to_owned())]
    }

    #[test]
    fn words_are_found_as_whole_words() {
        assert_eq!(found("a\nIt is Told twice.\n"), one(2, "told"));
        assert_eq!(found("untold, retells, intelligent"), []);
    }

    #[test]
    fn several_words_are_found_across_lines_and_not_across_punctuation() {
        assert_eq!(found("The noise *is\nnone* here."), one(1, "is none"));
        assert_eq!(found("So it is. None is left."), []);
        assert_eq!(found("So it is\n\nnone"), []);
        assert_eq!(found("| it is | none |"), []);
    }

    #[test]
    fn terms_of_the_field_are_allowed() {
        assert_eq!(found("a simply supported edge; what to do first"), []);
        assert_eq!(found("it is simply there"), one(1, "simply"));
    }

    #[test]
    fn of_two_entries_the_longer_one_is_named() {
        assert_eq!(found("what is left"), one(1, "what is left"));
        assert_eq!(found("| what it says |"), one(1, "what it says"));
        assert_eq!(found("such an error, such as"), one(1, "such an"));
    }

    #[test]
    fn the_list_is_as_the_search_takes_it() {
        for (k, (phrase, suggestion)) in LIST.iter().enumerate() {
            assert_eq!(phrase.to_lowercase(), *phrase);
            assert!(!suggestion.is_empty(), "{phrase}");
            assert!(LIST[..k].iter().all(|(other, _)| other != phrase), "{phrase} twice");
            assert_eq!(found(phrase), one(1, phrase));
        }
    }
}
