//! How deep the stack can get, by the frames of the functions and who calls whom.
//!
//! What this can say and what not: every call by name is followed, and every frame is taken at its largest. A call through a
//! register may lead to every function whose address is in the image somewhere, but for the callers of [`INDIRECT`].
//! The functions of a circle of calls are counted once each, which is no bound where a circle is run through more often;
//! it is the formatting of text.

use std::collections::BTreeMap;

use anyhow::Context;
use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;

use super::calls::{Image, Number};
use super::panics;

/// What an interrupt puts on the stack before its first instruction: with the floating-point registers, and four bytes
/// to align it (ARM DDI 0403, B1.5.7).
const EXCEPTION_BYTES: u32 = 108;

/// The start, all of it before the first interrupt.
const START: &str = "main";

/// What `main` ends in, and the functions that the hardware calls, each with its priority in `src/main.rs`: of each
/// priority one at most is running.
const ROOTS: [(&str, u8); 8] = [
    ("firmware::app::idle", 0),
    ("SOFTWARE_1", 1),
    ("SOFTWARE_2", 2),
    ("ASSEMBLE", 3),
    ("CABLE", 3),
    ("FLUXGATE", 4),
    ("SCALAR", 5),
    ("NMEA", 5),
];

/// What indirect calls lead to where it is known: caller, and what the names of its callees begin with.
const INDIRECT: [(&str, &str); 3] = [
    // The format's own function reads a line, and a closure of it checks its settings.
    ("SCALAR", "towmag::sensors::scalar::"),
    ("towmag::sensors::scalar::ScalarSettings::build", "core::ops::function::FnOnce::call_once"),
    // `waited`, a closure that on a board is nothing; closures that became functions all have this name.
    ("firmware::app::idle", "core::ops::function::FnOnce::call_once"),
];

/// Depths of all functions, with all that they call.
struct Depths {
    bytes: BTreeMap<Number, u32>,
    /// What comes next on the deepest way down.
    next: BTreeMap<Number, Number>,
    /// Circles of calls.
    circles: Vec<Vec<Number>>,
}

/// Print the depth of each priority, and of all on top of each other; an error where the stack has no room for that.
pub fn report() -> anyhow::Result<()> {
    let image = super::image()?;
    let depths = Depths::of(&image);
    for (caller, start) in INDIRECT {
        let is_there = image.address_taken.iter().any(|number| image.functions[*number].name.starts_with(start));
        anyhow::ensure!(is_there, "{caller} calls {start}, of which no address is kept: see INDIRECT");
    }
    let mut worst: BTreeMap<u8, u32> = BTreeMap::new();
    println!("priority  bytes  deepest way");
    let start = image.named(START).with_context(|| format!("no function {START}"))?;
    println!("   start {:6}  {}", depths.bytes[&start], depths.way(&image, start));
    for (root, priority) in ROOTS {
        let number = image.named(root).with_context(|| format!("no function {root}"))?;
        let entry = if priority == 0 { image.functions[start].code.frame_bytes } else { EXCEPTION_BYTES };
        let bytes = depths.bytes[&number] + entry;
        println!("{priority:8} {bytes:6}  {}", depths.way(&image, number));
        let most = worst.entry(priority).or_default();
        *most = (*most).max(bytes);
    }
    let sum: u32 = worst.values().sum();
    let end = image.named(panics::END).context("no panic")?;
    let (most, there_is) = (sum + depths.bytes[&end], image.stack_bytes);
    println!("all on top of each other: {sum} of {there_is} bytes; with a panic, which restarts: {most}");
    anyhow::ensure!(most <= there_is, "the stack of memory.x is too small");
    for circle in &depths.circles {
        println!("circle of {} functions, {} bytes once around", circle.len(), frames(&image, circle));
    }
    let unknown: Vec<_> = image.functions.iter().filter(|function| function.code.unknown > 0).collect();
    unknown.iter().for_each(|function| println!("not understood: {}", function.name));
    Ok(())
}

fn frames(image: &Image, of: &[Number]) -> u32 {
    of.iter().map(|number| image.functions[*number].code.frame_bytes).sum()
}

impl Depths {
    fn of(image: &Image) -> Self {
        let graph = graph(image);
        let mut depths = Self { bytes: BTreeMap::new(), next: BTreeMap::new(), circles: Vec::new() };
        // Those that are called come before those that call them.
        for group in tarjan_scc(&graph) {
            let below = group.iter().flat_map(|number| graph.neighbors(*number));
            let below = below.filter_map(|callee| Some((*depths.bytes.get(&callee)?, callee))).max();
            let bytes = frames(image, &group) + below.map_or(0, |(bytes, _)| bytes);
            for number in &group {
                depths.bytes.insert(*number, bytes);
                if let Some((_, callee)) = below {
                    depths.next.insert(*number, callee);
                }
            }
            if group.len() > 1 || graph.contains_edge(group[0], group[0]) {
                depths.circles.push(group);
            }
        }
        depths
    }

    /// The functions with the largest frames on the deepest way down.
    fn way(&self, image: &Image, from: Number) -> String {
        let ways = std::iter::successors(Some(from), |number| self.next.get(number).copied());
        let steps = ways.map(|number| {
            let function = &image.functions[number];
            match self.circles.iter().find(|circle| circle.contains(&number)) {
                Some(circle) => format!("{} and its circle {}", function.name, frames(image, circle)),
                None => format!("{} {}", function.name, function.code.frame_bytes),
            }
        });
        steps.collect::<Vec<_>>().join(" > ")
    }
}

/// Who calls whom, but for panics: they do not come back.
fn graph(image: &Image) -> DiGraphMap<Number, ()> {
    let mut graph = DiGraphMap::new();
    for (number, function) in image.functions.iter().enumerate() {
        graph.add_node(number);
        let from_panic = panics::is_way(&function.name);
        let known = INDIRECT.iter().find(|(caller, _)| *caller == function.name).map(|(_, callee)| *callee);
        let indirect = image.address_taken.iter().filter(|callee| {
            function.code.indirect_calls > 0
                && known.is_none_or(|start| image.functions[**callee].name.starts_with(start))
        });
        for callee in function.calls.iter().chain(indirect) {
            if from_panic || !panics::is_way(&image.functions[*callee].name) {
                graph.add_edge(number, *callee, ());
            }
        }
    }
    graph
}
