//! What is there for tests alone.

use proc_macro2::{TokenStream, TokenTree};
use syn::Attribute;

/// Whether a `#[cfg(...)]` or `#[test]` among the attributes leaves an item out of every build but that of tests.
pub(super) fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute.meta.require_list().is_ok_and(|list| asks_for_test(list.tokens.clone()))
    })
}

/// Whether `test` stands in a condition, and not below a `not(...)`.
fn asks_for_test(condition: TokenStream) -> bool {
    let mut negated = false;
    for token in condition {
        match token {
            TokenTree::Ident(word) if word == "test" => return true,
            TokenTree::Ident(word) => negated = word == "not",
            TokenTree::Group(group) if !negated && asks_for_test(group.stream()) => return true,
            _ => negated = false,
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use syn::parse_quote;

    #[test]
    fn test_conditions_are_told_from_others() {
        let for_tests: [Attribute; 3] =
            [parse_quote!(#[cfg(test)]), parse_quote!(#[cfg(all(test, unix))]), parse_quote!(#[test])];
        let others: [Attribute; 3] =
            [parse_quote!(#[cfg(not(test))]), parse_quote!(#[cfg(feature = "test")]), parse_quote!(#[derive(Debug)])];
        assert!(for_tests.iter().all(|attribute| is_for_tests(std::slice::from_ref(attribute))));
        assert!(!others.iter().any(|attribute| is_for_tests(std::slice::from_ref(attribute))));
    }
}
