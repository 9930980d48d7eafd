//! `cargo xtask measured`: the quick figures of `docs/measured.md`, measured again and written into it.

mod differ;
mod figures;
mod markdown;
mod page;
mod tools;

use anyhow::{Context, Result, bail, ensure};

use crate::repository;
use figures::{FIGURES, Figure, Needs};
pub use tools::{Tools, text};

/// Where the figures stand; one may stand on several pages.
const PAGES: [&str; 2] = ["docs/measured.md", "README.md"];

/// Measure the figures of these names, or all; write them into the pages, or fail where one differs from a page.
/// With the host program in release, or as the tests have it.
pub fn run(names: &[String], check: bool, is_release: bool) -> Result<()> {
    let figures = chosen(names)?;
    let tools = Tools::new(is_release)?;
    let mut differing = Vec::new();
    for figure in figures {
        if let Some(missing) = figure.needs.missing() {
            ensure!(names.is_empty(), "{} needs {missing}", figure.name);
            println!("{}: left as it is: it needs {missing}", figure.name);
            continue;
        }
        let measured = (figure.measure)(&tools).with_context(|| figure.name)?;
        if differs(figure, &measured, check)? {
            differing.push(figure.name);
        }
    }
    if check && !differing.is_empty() {
        bail!("not as the pages say; `cargo xtask measured {}` writes it", differing.join(" "));
    }
    Ok(())
}

/// Whether a figure is not what a page says; if so it is written there, unless that is only to be checked.
fn differs(figure: &Figure, measured: &str, check: bool) -> Result<bool> {
    let mut differs = false;
    for name in PAGES {
        let page = repository::text(name).with_context(|| format!("{name} is not there"))?;
        let Some(stands) = page::figure(&page, figure.name)? else { continue };
        if let Some(difference) = differ::difference(stands, measured, figure.share) {
            println!("{}: differs from {name}\n{difference}", figure.name);
            differs = true;
            if !check {
                std::fs::write(repository::root().join(name), page::with_figure(&page, figure.name, measured)?)?;
            }
        }
    }
    if !differs {
        println!("{}: as it stands", figure.name);
    }
    Ok(differs)
}

/// The figures of these names; all of them without a name.
fn chosen(names: &[String]) -> Result<Vec<&'static Figure>> {
    for name in names {
        let known = || FIGURES.iter().map(|figure| figure.name).collect::<Vec<_>>().join(", ");
        ensure!(FIGURES.iter().any(|figure| figure.name == name), "there is no figure {name}; there are: {}", known());
    }
    let is_chosen = |figure: &&Figure| names.is_empty() || names.iter().any(|name| name == figure.name);
    Ok(FIGURES.iter().filter(is_chosen).collect())
}

impl Needs {
    fn missing(self) -> Option<&'static str> {
        match self {
            Self::Nothing => None,
            Self::Flights => tools::flights().is_none().then_some("the flight recordings (TOWMAG_DATA)"),
            Self::Emulator => (!tools::has_emulator()).then_some("qemu-system-arm"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_figure_stands_on_a_page_and_no_other_does() {
        let pages = PAGES.map(|name| repository::text(name).unwrap());
        let mut on_pages: Vec<&str> = pages.iter().flat_map(|page| page::names(page)).collect();
        on_pages.sort_unstable();
        on_pages.dedup();
        let mut known: Vec<&str> = FIGURES.iter().map(|figure| figure.name).collect();
        known.sort_unstable();
        assert_eq!(on_pages, known);
        for name in known {
            let on_page = pages.iter().filter_map(|page| page::figure(page, name).unwrap());
            assert!(
                on_page.clone().count() > 0 && on_page.into_iter().all(|figure| !figure.trim().is_empty()),
                "{name}"
            );
        }
    }

    #[test]
    fn an_unknown_name_is_refused_with_those_there_are() {
        let message = chosen(&["nonsense".into()]).err().unwrap().to_string();
        assert!(message.contains("nonsense") && message.contains("sample"), "{message}");
        assert_eq!(chosen(&[]).unwrap().len(), FIGURES.len());
    }
}
