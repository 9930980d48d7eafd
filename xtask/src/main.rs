//! `cargo xtask`: the repository's own chores.

use clap::Parser;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "The repository's own chores")]
enum Chore {
    /// How long functions are, area by area.
    Shape,
}

fn main() {
    match Chore::parse() {
        Chore::Shape => print!("{}", xtask::shape::table()),
    }
}
