//! `cargo xtask`: the repository's own chores.

use std::process::ExitCode;

use clap::Parser;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "The repository's own chores")]
enum Chore {
    /// Measure the quick figures of docs/measured.md again and write them there.
    ///
    /// What needs flight recordings (TOWMAG_DATA) or qemu-system-arm is left as it is where they are not.
    Measured {
        /// Figures, as their markers call them; all without one.
        names: Vec<String>,
        /// Write nothing; fail where a figure differs by more than rounding.
        #[arg(long)]
        check: bool,
        /// With the host program that the tests are built with: every bit is the same, times are not.
        #[arg(long)]
        unoptimised: bool,
    },
    /// Make docs/report.png, the picture of the README, with a headless chromium.
    Picture,
    /// How long functions are, area by area.
    Shape,
    /// Hold the functions of the firmware's image that can panic against firmware/panics.toml.
    Panics,
    /// How deep the stack of the firmware's image can get.
    Stack,
}

fn main() -> ExitCode {
    let done = match Chore::parse() {
        Chore::Measured { names, check, unoptimised } => xtask::measured::run(&names, check, !unoptimised),
        Chore::Picture => xtask::picture::make(),
        Chore::Panics => xtask::image::check_panics(),
        Chore::Stack => xtask::image::report_stack(),
        Chore::Shape => {
            print!("{}", xtask::shape::table());
            Ok(())
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:#}");
            ExitCode::FAILURE
        }
    }
}
