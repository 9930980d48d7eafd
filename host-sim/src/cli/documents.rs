//! What is made from the definitions of the commands: completions for shells, and manual pages.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use clap::CommandFactory;
use clap_complete::Shell;
use host_sim::error::HostError;
use host_sim::output::OutputDir;

use super::arguments::Cli;

const PROGRAM: &str = "host-sim";

/// Print what `shell` loads.
pub(super) fn completions(shell: Shell) -> Result<(), HostError> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), PROGRAM, &mut script);
    match io::stdout().write_all(&script) {
        // Whoever reads them has had enough.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => Ok(written?),
    }
}

/// Write a page for the program and one for each command.
pub(super) fn manual(out: &Path) -> Result<(), HostError> {
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    let mut pages = Vec::new();
    gather(&program, PROGRAM, &mut pages)?;
    let names: Vec<&str> = pages.iter().map(|(name, _)| name.as_str()).collect();
    OutputDir::check(out, &names)?;
    let output = OutputDir::create(out)?;
    pages.iter().try_for_each(|(name, page)| output.write(name, page))?;
    Ok(output.commit(&format!("{PROGRAM}.1"))?)
}

fn gather(command: &clap::Command, name: &str, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), HostError> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone().display_name(name.to_string())).title(name).render(&mut page)?;
    pages.push((format!("{name}.1"), page));
    command.get_subcommands().try_for_each(|below| gather(below, &format!("{name}-{}", below.get_name()), pages))
}
