//! `cargo xtask picture`: the README's picture, from the page that its first command makes.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::measured::{Tools, text};
use crate::repository;

const PICTURE: &str = "docs/report.png";
/// Table, field and residual; what follows on the page is left out.
const SIZE: &str = "--window-size=1200,1300";

/// Make the picture anew.
pub fn make() -> Result<()> {
    let tools = Tools::new(true)?;
    let out = tools.path("picture");
    tools.host_sim(&["compare", "sample/calibration.csv", "sample/survey.csv", "--out", text(&out)?])?;
    let picture = repository::root().join(PICTURE);
    let page = out.join("report.html");
    let arguments =
        ["--headless", "--disable-gpu", "--no-sandbox", "--hide-scrollbars", "--virtual-time-budget=20000", SIZE];
    let screenshot = format!("--screenshot={}", text(&picture)?);
    let status =
        Command::new(browser()?).args(arguments).args([&screenshot, &format!("file://{}", text(&page)?)]).status();
    ensure!(status?.success(), "the browser has failed");
    println!("{PICTURE} is new: look at it.");
    Ok(())
}

fn browser() -> Result<PathBuf> {
    if let Some(chosen) = std::env::var_os("CHROME") {
        return Ok(chosen.into());
    }
    let path = std::env::var_os("PATH").unwrap_or_default();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let files: Vec<PathBuf> =
        std::env::split_paths(&path).flat_map(|folder| names.map(|name| folder.join(name))).collect();
    files.into_iter().find(|file| file.is_file()).context("no chromium on PATH, and CHROME is not set")
}
