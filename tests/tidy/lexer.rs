//! Rust text in, tokens out: enough of the language to tell code from comments and strings.
//!
//! No parser: the rules ask for words and paths, and whether they stand in test code.

/// A token and its line, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token<'a> {
    pub text: &'a str,
    pub line: usize,
}

/// The tokens of `text`: words, numbers, and every other character by itself. Comments, and what is
/// in string and character literals, are left out.
pub(crate) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let (mut at, mut line) = (0, 1);
    while at < text.len() {
        let rest = &text[at..];
        let (length, token) = next(rest);
        if token {
            tokens.push(Token { text: &rest[..length], line });
        }
        line += rest[..length].matches('\n').count();
        at += length;
    }
    tokens
}

/// The length of what `rest` begins with, and whether it is a token.
fn next(rest: &str) -> (usize, bool) {
    let first = rest.chars().next().expect("not at the end");
    if first.is_whitespace() {
        return (first.len_utf8(), false);
    }
    if let Some(length) = comment(rest).or_else(|| raw_string(rest)).or_else(|| quoted(rest)) {
        return (length, false);
    }
    if first.is_alphabetic() || first == '_' {
        return (word(rest), true);
    }
    if first.is_ascii_digit() {
        return (number(rest), true);
    }
    (first.len_utf8(), true)
}

fn comment(rest: &str) -> Option<usize> {
    if rest.starts_with("//") {
        return Some(rest.find('\n').unwrap_or(rest.len()));
    }
    if !rest.starts_with("/*") {
        return None;
    }
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        let step = match &rest.as_bytes()[at..] {
            [b'/', b'*', ..] => {
                depth += 1;
                2
            }
            [b'*', b'/', ..] => {
                depth -= 1;
                2
            }
            _ => 1,
        };
        at += step;
        if depth == 0 {
            break;
        }
    }
    Some(at)
}

/// `r"..."`, `r#"..."#`, with or without a `b` or `c` before it.
fn raw_string(rest: &str) -> Option<usize> {
    let body = rest.strip_prefix(['b', 'c']).unwrap_or(rest).strip_prefix('r')?;
    let hashes = body.len() - body.trim_start_matches('#').len();
    let body = body[hashes..].strip_prefix('"')?;
    let close = format!("\"{}", "#".repeat(hashes));
    let end = body.find(&close)? + close.len();
    Some(rest.len() - body.len() + end)
}

/// `"..."`, `b"..."`, `'c'`, `b'c'`; not a lifetime.
fn quoted(rest: &str) -> Option<usize> {
    let body = rest.strip_prefix(['b', 'c']).unwrap_or(rest);
    let quote = body.chars().next().filter(|c| *c == '"' || *c == '\'')?;
    let mut inside = body[1..].char_indices();
    if quote == '\'' {
        let mut ahead = inside.clone();
        let (first, second) = (ahead.next()?.1, ahead.next()?.1);
        if first != '\\' && second != '\'' {
            return None;
        }
    }
    while let Some((at, c)) = inside.next() {
        match c {
            '\\' => drop(inside.next()),
            c if c == quote => return Some(rest.len() - body.len() + 1 + at + 1),
            _ => {}
        }
    }
    Some(rest.len())
}

fn word(rest: &str) -> usize {
    rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
}

/// A number with its suffix; a point belongs to it where a digit follows.
fn number(rest: &str) -> usize {
    let whole = word(rest);
    let mut after = rest[whole..].chars();
    if after.next() == Some('.') && after.next().is_some_and(|c| c.is_ascii_digit()) {
        whole + 1 + word(&rest[whole + 1..])
    } else {
        whole
    }
}

/// The tokens without the items that `#[cfg(test)]` stands before.
pub(crate) fn without_tests<'a>(tokens: &[Token<'a>]) -> Vec<Token<'a>> {
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if begins(&tokens[at..], &["#", "[", "cfg", "(", "test", ")", "]"]) {
            at += 7 + item_length(&tokens[at + 7..]);
        } else {
            kept.push(tokens[at]);
            at += 1;
        }
    }
    kept
}

/// Up to the item's `;`, or to the end of its first braces.
fn item_length(tokens: &[Token<'_>]) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate() {
        match token.text {
            "{" => depth += 1,
            "}" if depth == 1 => return at + 1,
            "}" => depth -= 1,
            ";" if depth == 0 => return at + 1,
            _ => {}
        }
    }
    tokens.len()
}

/// Whether `tokens` begins with these texts.
pub(crate) fn begins(tokens: &[Token<'_>], texts: &[&str]) -> bool {
    tokens.len() >= texts.len() && tokens.iter().zip(texts).all(|(token, text)| token.text == *text)
}
