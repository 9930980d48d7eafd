//! Files that use each other, directly or round about.

use std::fmt;
use std::path::{Path, PathBuf};

use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;

use super::arrows::Arrow;

/// Files each of which leads to every other, with the arrows among them.
#[derive(Clone, Debug)]
pub struct Circle {
    /// Arrows from one of the files to another.
    pub arrows: Vec<Arrow>,
    files: Vec<PathBuf>,
}

/// All circles; none is part of another.
pub fn circles(arrows: &[Arrow]) -> Vec<Circle> {
    let pairs = arrows.iter().map(|arrow| (arrow.from.as_path(), arrow.to.as_path()));
    let graph: DiGraphMap<&Path, ()> = DiGraphMap::from_edges(pairs);
    let mut groups: Vec<Vec<&Path>> = tarjan_scc(&graph).into_iter().filter(|group| group.len() > 1).collect();
    groups.iter_mut().for_each(|group| group.sort());
    groups.sort();
    let circle = |files: Vec<&Path>| {
        let within = |arrow: &&Arrow| files.contains(&arrow.from.as_path()) && files.contains(&arrow.to.as_path());
        let arrows = arrows.iter().filter(within).cloned().collect();
        Circle { arrows, files: files.into_iter().map(Path::to_path_buf).collect() }
    };
    groups.into_iter().map(circle).collect()
}

impl fmt::Display for Circle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "circle of {} files", self.files.len())?;
        for arrow in &self.arrows {
            let names: Vec<&str> = arrow.names.iter().map(String::as_str).collect();
            let [from, to] = [&arrow.from, &arrow.to].map(|path| crate::repository::relative(path));
            writeln!(f, "  {from} -> {to}: {}", names.join(", "))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrow(from: &str, to: &str) -> Arrow {
        Arrow { from: from.into(), to: to.into(), names: [format!("{to}::x")].into() }
    }

    #[test]
    fn a_chain_is_none() {
        assert!(circles(&[arrow("a", "b"), arrow("b", "c"), arrow("a", "c")]).is_empty());
    }

    #[test]
    fn circles_are_found_with_their_arrows() {
        let arrows =
            [arrow("a", "b"), arrow("b", "c"), arrow("c", "a"), arrow("c", "d"), arrow("x", "y"), arrow("y", "x")];
        let found = circles(&arrows);
        assert_eq!(found.iter().map(|circle| circle.arrows.len()).collect::<Vec<_>>(), [3, 2]);
        assert_eq!(found[1].to_string(), "circle of 2 files\n  x -> y: y::x\n  y -> x: x::x\n");
    }
}
