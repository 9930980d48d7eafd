//! A formula as words and signs.

use crate::error::Wrong;

/// A word or sign of a formula, and the byte where it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Token<'a> {
    pub(super) at: usize,
    pub(super) what: What<'a>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum What<'a> {
    Number(f64),
    Name(&'a str),
    /// One of `+ - * / ^ < <= > >=`.
    Operator(&'a str),
    Open,
    Close,
    Comma,
}

/// All of them in order.
pub(super) fn tokens(text: &str) -> Result<Vec<Token<'_>>, Wrong> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        if first.is_whitespace() {
            at += first.len_utf8();
            continue;
        }
        let (what, len) = token(&text[at..], first).map_err(|reason| Wrong::new(at, reason))?;
        tokens.push(Token { at, what });
        at += len;
    }
    Ok(tokens)
}

/// The first token of a text, and how many bytes it has.
fn token(rest: &str, first: char) -> Result<(What<'_>, usize), String> {
    Ok(match first {
        '(' => (What::Open, 1),
        ')' => (What::Close, 1),
        ',' => (What::Comma, 1),
        '+' | '-' | '*' | '/' | '^' => (What::Operator(&rest[..1]), 1),
        '<' | '>' => {
            let len = if rest[1..].starts_with('=') { 2 } else { 1 };
            (What::Operator(&rest[..len]), len)
        }
        '0'..='9' | '.' => number(rest)?,
        _ if is_first_of_name(first) => {
            let len = rest.find(|c| !is_of_name(c)).unwrap_or(rest.len());
            (What::Name(&rest[..len]), len)
        }
        '=' => return Err("= is no part of a formula; compare with <, <=, > or >=".into()),
        _ => return Err(format!("{first:?} is no part of a formula")),
    })
}

/// Digits, a point, an exponent.
fn number(rest: &str) -> Result<(What<'_>, usize), String> {
    let digits = |from: usize| rest[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut len = digits(0);
    if rest[len..].starts_with('.') {
        len += 1 + digits(len + 1);
    }
    if rest[len..].starts_with(['e', 'E']) {
        let sign = usize::from(rest[len + 1..].starts_with(['+', '-']));
        let exponent = digits(len + 1 + sign);
        if exponent > 0 {
            len += 1 + sign + exponent;
        }
    }
    match rest[..len].parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((What::Number(value), len)),
        _ => Err(format!("{} is not a number", crate::error::quoted(&rest[..len]))),
    }
}

fn is_first_of_name(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_'
}

fn is_of_name(c: char) -> bool {
    is_first_of_name(c) || c.is_ascii_digit()
}
