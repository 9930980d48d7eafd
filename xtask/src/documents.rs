//! What the documentation points at.

use std::path::{Component, Path, PathBuf};

use pulldown_cmark::{Event, Options, Parser, Tag};

/// Where a page leads to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Pointer {
    /// A link or a picture, as it is written.
    Link(String),
    /// Text set as code.
    Code(String),
}

/// Every link and every piece of code within a line of a page.
pub fn pointers(markdown: &str) -> Vec<Pointer> {
    let pointer = |event| match event {
        Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
            Some(Pointer::Link(dest_url.into_string()))
        }
        Event::Code(text) => Some(Pointer::Code(text.into_string())),
        _ => None,
    };
    Parser::new_ext(markdown, Options::ENABLE_TABLES).filter_map(pointer).collect()
}

/// The file or folder of the repository that a link of a page means; `None` of a link to elsewhere or within the page,
/// an error where it leads out of the repository.
pub fn target(page: &str, link: &str) -> Option<Result<String, String>> {
    let path = link.split(['#', '?']).next().unwrap_or_default();
    if path.is_empty() || path.contains("://") || path.starts_with("mailto:") {
        return None;
    }
    let folder = Path::new(page).parent().unwrap_or(Path::new(""));
    let mut inside = PathBuf::new();
    for component in folder.join(path).components() {
        let stays = match component {
            Component::Normal(part) => {
                inside.push(part);
                true
            }
            Component::CurDir => true,
            Component::ParentDir => inside.pop(),
            Component::RootDir | Component::Prefix(_) => false,
        };
        if !stays {
            return Some(Err(link.to_string()));
        }
    }
    Some(Ok(inside.to_string_lossy().replace('\\', "/")))
}

/// Whether the repository has a file or a folder of this path.
pub fn exists(files: &[String], path: &str) -> bool {
    let folder = format!("{}/", path.trim_end_matches('/'));
    path.is_empty() || files.iter().any(|file| file == path || file.starts_with(&folder))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_pictures_and_code_are_pointers() {
        let page = "[a](b.md#c) ![d](e.png) `f.rs`\n\n| `g` |\n|---|\n| [h](i) |\n\n```\n[no](link)\n```\n";
        let links = pointers(page);
        let link = |text: &str| Pointer::Link(text.into());
        let code = |text: &str| Pointer::Code(text.into());
        assert_eq!(links, [link("b.md#c"), link("e.png"), code("f.rs"), code("g"), link("i")]);
    }

    #[test]
    fn links_are_relative_to_their_page() {
        assert_eq!(target("docs/a.md", "../README.md#x"), Some(Ok("README.md".into())));
        assert_eq!(target("README.md", "docs/a.md"), Some(Ok("docs/a.md".into())));
        assert_eq!(target("docs/a.md", "../../beside"), Some(Err("../../beside".into())));
        assert_eq!(target("docs/a.md", "#here"), None);
        assert_eq!(target("docs/a.md", "https://example.org/x"), None);
    }

    #[test]
    fn folders_exist_through_their_files() {
        let files = ["docs/a.md".to_string()];
        assert!(exists(&files, "docs/") && exists(&files, "docs/a.md") && !exists(&files, "doc"));
    }
}
