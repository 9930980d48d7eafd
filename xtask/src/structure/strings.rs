//! String literals of the code.

use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ExprLit, ExprStruct, Item, Lit, LitStr, Member};

use super::cfg_test::is_for_tests;
use super::source::SourceCrate;

/// A string literal and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Literal {
    /// Its file, relative to the root of the repository.
    pub file: String,
    /// Its line.
    pub line: usize,
    /// Its value.
    pub value: String,
}

/// The string literals of a crate, those in macros too; not those of attributes, comments and tests.
pub fn literals(source: &SourceCrate) -> Vec<Literal> {
    source.modules.iter().flat_map(|module| literals_of(&module.file, &module.items)).collect()
}

fn literals_of(file: &Path, items: &[Item]) -> Vec<Literal> {
    let mut collector = Collector { file: crate::repository::relative(file), found: Vec::new() };
    items.iter().for_each(|item| collector.visit_item(item));
    collector.found
}

struct Collector {
    file: String,
    found: Vec<Literal>,
}

impl Collector {
    fn scan(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => self.scan(group.stream()),
                TokenTree::Literal(literal) => {
                    if let Lit::Str(text) = Lit::new(literal) {
                        self.visit_lit_str(&text);
                    }
                }
                _ => {}
            }
        }
    }
}

impl<'ast> Visit<'ast> for Collector {
    fn visit_lit_str(&mut self, literal: &'ast LitStr) {
        let line = literal.span().start().line;
        self.found.push(Literal { file: self.file.clone(), line, value: literal.value() });
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.scan(call.tokens.clone());
    }

    fn visit_item(&mut self, item: &'ast Item) {
        if !is_for_tests(super::source::attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_attribute(&mut self, _: &'ast Attribute) {}
}

/// The names that a file of an effect gives: `name: "..."` of its `SPEC`, or a constant of such a name by itself.
pub fn effect_names(items: &[Item]) -> Vec<String> {
    items.iter().filter_map(effect_name).collect()
}

fn effect_name(item: &Item) -> Option<String> {
    let (name, value) = match item {
        Item::Const(item) => (&item.ident, &item.expr),
        Item::Static(item) => (&item.ident, &item.expr),
        _ => return None,
    };
    match &**value {
        Expr::Struct(spec) if name == "SPEC" => field(spec, "name"),
        Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => {
            Some(text.value()).filter(|text| *text == name.to_string().to_lowercase())
        }
        _ => None,
    }
}

/// A field's text.
fn field(spec: &ExprStruct, name: &str) -> Option<String> {
    let is_it = |member: &Member| matches!(member, Member::Named(field) if field == name);
    match &spec.fields.iter().find(|field| is_it(&field.member))?.expr {
        Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) => Some(text.value()),
        _ => None,
    }
}

/// Whether a name stands in a text as a word of its own; `name.key` is another word, that of a key in a file.
pub fn has_word(text: &str, name: &str) -> bool {
    let is_part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    text.match_indices(name).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + name.len()..]);
        let key = after.strip_prefix('.').and_then(|key| key.chars().next());
        !is_part(before.chars().next_back()) && !is_part(after.chars().next()) && !is_part(key)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_found_in_expressions_and_macros_and_not_in_attributes_and_tests() {
        let text = "/// doc\n#[doc = \"attribute\"]\nfn f(x: &str) {\n    g(\"one\");\n    assert!(x == \"two\", [\"three\"]);\n}\n\
                    #[cfg(test)]\nfn h() { g(\"test\"); }";
        let found = literals_of(Path::new("x.rs"), &syn::parse_file(text).unwrap().items);
        let shown: Vec<String> = found.iter().map(|literal| format!("{} {}", literal.line, literal.value)).collect();
        assert_eq!(shown, ["4 one", "5 two", "5 three"]);
    }

    #[test]
    fn an_effect_gives_its_name() {
        let text = "const PARAMETERS: &[P] = &[P { name: \"lag_s\" }];\nstatic SPEC: Spec = Spec { name: \"scalar_lag\" };\n\
                    pub const FIRMWARE_MISMATCH: &str = \"firmware_mismatch\";\nconst HINT: &str = \"other\";";
        assert_eq!(effect_names(&syn::parse_file(text).unwrap().items), ["scalar_lag", "firmware_mismatch"]);
    }

    #[test]
    fn words_end_where_names_end() {
        assert!(has_word("scalar_lag:lag_s=0.05", "scalar_lag") && has_word("is scalar_lag", "scalar_lag"));
        assert!(has_word("a scalar_lag.", "scalar_lag"));
        assert!(!has_word("scalar_lags", "scalar_lag") && !has_word("my_scalar_lag", "scalar_lag"));
        assert!(!has_word("dead_zone.half_angle_deg", "dead_zone"));
    }
}
