//! What `diagnose` says of each of the eight flight recordings.

use anyhow::{Context, Result};
use serde_json::Value;

use crate::measured::markdown::{Table, list, number, three_digits, word};
use crate::measured::tools::{Tools, flights, text};

pub(super) fn measure(tools: &Tools) -> Result<String> {
    let mut table = Table::new(&["recording", "verdict", "fluxgate's magnitude", "scalar"]);
    for fluxgate in ["b", "c"] {
        for scalar in [4, 5] {
            for part in ["calibration", "survey"] {
                let folder = flights().context("no flight recordings")?;
                let recording = folder.join(format!("flux_{fluxgate}_mag_{scalar}_{part}.csv"));
                let diagnosis = tools.host_sim_json(&["diagnose", text(&recording)?], "diagnosis.json")?;
                let name = format!("{} {scalar} {part}", fluxgate.to_uppercase());
                let channels = [channel(&diagnosis, "fluxgate")?, channel(&diagnosis, "scalar")?];
                table.row(&[&[name, word(&diagnosis, "verdict")?.replace('_', " ")][..], &channels].concat());
            }
        }
    }
    Ok(table.into_text())
}

/// Residual over noise, and what is named with the share that it closes.
fn channel(diagnosis: &Value, channel: &str) -> Result<String> {
    let mut parts = Vec::new();
    for of in list(diagnosis, "channels")?.iter().filter(|of| of["channel"] == channel) {
        let [residual, noise] = ["residual_rms_nT", "noise_floor_rms_nT"].map(|key| number(of, key));
        parts.push(format!("{} nT, noise {}", three_digits(residual?), three_digits(noise?)));
    }
    for effect in list(diagnosis, "effects")?.iter().filter(|effect| effect["channel"] == channel) {
        let closed = effect["gap_closed"]["fraction"].as_f64();
        let closed = closed.map_or("-".to_string(), |fraction| format!("{:.0} %", 100.0 * fraction));
        parts.push(format!("`{}`{} {closed}", word(effect, "name")?, parameters(effect)?));
    }
    Ok(parts.join("; "))
}

/// The parameters that say which one it is: at most three.
fn parameters(effect: &Value) -> Result<String> {
    let mut shown = Vec::new();
    for parameter in list(effect, "parameters")?.iter().take(3) {
        if let Some(value) = parameter["value"].as_f64() {
            shown.push(format!("{} {}", word(parameter, "name")?, three_digits(value)));
        }
    }
    Ok(if shown.is_empty() { String::new() } else { format!(" ({})", shown.join(", ")) })
}
