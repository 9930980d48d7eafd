//! What an operator can tell the body.

use super::frame::MAX_BODY;
use crate::body::UnixTime;
use crate::store::{Parameter, ValueText};

/// Longest line, bytes: the longest command with a good deal of blanks, its number and its CRC.
pub const LONGEST_LINE: usize = 96;

/// A line of text that goes into one frame.
pub type TextLine = heapless::String<MAX_BODY>;

/// A word of the operator's, for an answer; what is longer is cut off.
pub type Word = heapless::String<24>;

/// A command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Command {
    /// `status`: how the body is.
    Status,
    /// `get`: all settings, `get name`: one.
    Get(Option<Parameter>),
    /// `set name value`: change it; nothing holds and nothing is stored before `save`.
    Set {
        /// Which.
        parameter: Parameter,
        /// To what, as typed.
        value: ValueText,
    },
    /// `save`: store what was `set`.
    Save,
    /// `calibrate start|fluxgate|stop`, `calibrate accept|discard yes`.
    Calibrate(Calibrate),
    /// `log start` (true) or `log stop yes`.
    Log(bool),
    /// `time ask`: what the timer shows; see [`TimerTold`](super::TimerTold).
    TimeAsk,
    /// `time set seconds`, or `time set seconds.fraction@stamp+-error`.
    TimeSet {
        /// The time, within the years 2020 to 2099.
        time: UnixTime,
        /// What the timer showed then, microseconds; `None` for when the line came.
        stamp_us: Option<u32>,
    },
    /// `selftest`: what each part finds out about itself.
    SelfTest,
    /// `help`: the commands.
    Help,
    /// `reset yes`: start anew, with the stored settings.
    Reset,
}

/// The steps of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibrate {
    /// Begin to record, for the 18 coefficients.
    Start,
    /// Begin to record, for the axes of the fluxgate.
    Fluxgate,
    /// End and solve.
    Stop,
    /// Keep the result.
    Accept,
    /// Give it up.
    Discard,
}

/// What `help` answers, line by line.
pub const HELP: [&str; 13] = [
    "status                         how the body is, and every fault counter that is not zero",
    "get [name]                     all settings, or one",
    "set name value                 change a setting, for save to store",
    "save                           store what was set; but for log, it holds from the next start",
    "calibrate start                begin to record; then roll, pitch and yaw on four headings",
    "calibrate fluxgate             begin to record; then turn slowly through all directions, far from iron",
    "calibrate stop                 end either and solve: how good it is, and what was found",
    "calibrate accept yes           keep what was found and start anew with it; calibrate discard yes: do not",
    "log start | stop yes           epochs to the card; holds beyond a restart",
    "time set seconds               seconds since 1970-01-01 UTC; host-sim listen sets it by the ship's clock",
    "selftest                       crystal, converter, sensors, card, settings, wires: 3 s, then what was found",
    "reset yes                      start anew with the stored settings",
    "help                           these lines",
];

/// First second of 2020 and of 2100: milliseconds and slips of the finger lie outside.
const TIMES_S: core::ops::Range<u64> = 1_577_836_800..4_102_444_800;

/// How far off a time may be that a person types, microseconds.
const TYPED_ERROR_US: u32 = 1_000_000;

/// Why a line is no command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommandError {
    /// No command has this name.
    Unknown(Word),
    /// No setting has this name.
    UnknownSetting(Word),
    /// A known command, but not like this; how it is written.
    Usage(&'static str),
    /// A command that ends or replaces something, without the `yes`; how it is written with it.
    NotConfirmed(&'static str),
}

impl core::fmt::Display for CommandError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unknown(word) => write!(f, "error: no command \"{word}\": type help"),
            Self::UnknownSetting(word) => write!(f, "error: no setting \"{word}\": type get for all of them"),
            Self::Usage(usage) => write!(f, "error: type {usage}"),
            Self::NotConfirmed(usage) => write!(f, "not done: to confirm it, type {usage}"),
        }
    }
}

impl core::error::Error for CommandError {}

/// The command in a line of text. Words are parted by blanks, capital letters in command words are as good as small ones.
pub fn parse(line: &str) -> Result<Command, CommandError> {
    let mut words = line.split_ascii_whitespace();
    let [first, second, third, surplus] = [words.next(), words.next(), words.next(), words.next()];
    let command = first.unwrap_or_default();
    let is = |name: &str| command.eq_ignore_ascii_case(name);
    let words = [second, third, surplus];
    if is("status") {
        alone(Command::Status, words, "status")
    } else if is("get") {
        get(words)
    } else if is("set") {
        set(words)
    } else if is("save") {
        alone(Command::Save, words, "save")
    } else if is("calibrate") {
        calibrate(words)
    } else if is("log") {
        log(words)
    } else if is("time") {
        time(words)
    } else if is("selftest") {
        alone(Command::SelfTest, words, "selftest")
    } else if is("help") || is("?") {
        alone(Command::Help, words, "help")
    } else if is("reset") {
        confirmed(Command::Reset, words, "reset yes")
    } else {
        Err(CommandError::Unknown(cut(command)))
    }
}

/// The words after the first; of the last only matters whether there is one.
type Rest<'a> = [Option<&'a str>; 3];

fn alone(command: Command, rest: Rest<'_>, usage: &'static str) -> Result<Command, CommandError> {
    if rest == [None; 3] { Ok(command) } else { Err(CommandError::Usage(usage)) }
}

/// What ends or replaces something wants a `yes` in the same line, which no noise and no slip of the finger makes.
fn confirmed(command: Command, rest: Rest<'_>, usage: &'static str) -> Result<Command, CommandError> {
    match rest {
        [Some(yes), None, _] if yes.eq_ignore_ascii_case("yes") => Ok(command),
        [None, ..] => Err(CommandError::NotConfirmed(usage)),
        _ => Err(CommandError::Usage(usage)),
    }
}

fn get(rest: Rest<'_>) -> Result<Command, CommandError> {
    match rest {
        [None, ..] => Ok(Command::Get(None)),
        [Some(name), None, _] => Ok(Command::Get(Some(named(name)?))),
        _ => Err(CommandError::Usage("get or get name")),
    }
}

fn set(rest: Rest<'_>) -> Result<Command, CommandError> {
    const USAGE: CommandError = CommandError::Usage("set name value");
    let [Some(name), Some(value), None] = rest else { return Err(USAGE) };
    let parameter = named(name)?;
    Ok(Command::Set { parameter, value: ValueText::try_from(value).map_err(|_| USAGE)? })
}

fn calibrate([step, rest @ ..]: Rest<'_>) -> Result<Command, CommandError> {
    const USAGE: &str = "calibrate start, fluxgate, stop, accept yes or discard yes";
    let rest = [rest[0], rest[1], None];
    let is = |name: &str| step.is_some_and(|step| step.eq_ignore_ascii_case(name));
    if is("start") {
        alone(Command::Calibrate(Calibrate::Start), rest, USAGE)
    } else if is("fluxgate") {
        alone(Command::Calibrate(Calibrate::Fluxgate), rest, USAGE)
    } else if is("stop") {
        alone(Command::Calibrate(Calibrate::Stop), rest, USAGE)
    } else if is("accept") {
        confirmed(Command::Calibrate(Calibrate::Accept), rest, "calibrate accept yes")
    } else if is("discard") {
        confirmed(Command::Calibrate(Calibrate::Discard), rest, "calibrate discard yes")
    } else {
        Err(CommandError::Usage(USAGE))
    }
}

fn log([step, rest @ ..]: Rest<'_>) -> Result<Command, CommandError> {
    const USAGE: &str = "log start or log stop yes";
    let rest = [rest[0], rest[1], None];
    let is = |name: &str| step.is_some_and(|step| step.eq_ignore_ascii_case(name));
    if is("start") {
        alone(Command::Log(true), rest, USAGE)
    } else if is("stop") {
        confirmed(Command::Log(false), rest, "log stop yes")
    } else {
        Err(CommandError::Usage(USAGE))
    }
}

fn time(rest: Rest<'_>) -> Result<Command, CommandError> {
    const USAGE: CommandError =
        CommandError::Usage("time set seconds, since 1970-01-01 UTC, of the years 2020 to 2099");
    match rest {
        [Some(ask), None, _] if ask.eq_ignore_ascii_case("ask") => Ok(Command::TimeAsk),
        [Some(set), Some(what), None] if set.eq_ignore_ascii_case("set") => time_set(what).ok_or(USAGE),
        _ => Err(USAGE),
    }
}

/// `1790000000`, or, as a program says it, `1790000000.123456@3123456789+-5000`: the timer's stamp and the error in
/// microseconds. A typed time is taken for one that may be off by a second.
fn time_set(text: &str) -> Option<Command> {
    let (seconds, at) = match text.split_once('@') {
        Some((seconds, at)) => (seconds, Some(at.split_once("+-")?)),
        None => (text, None),
    };
    let (whole, fraction) = seconds.split_once('.').unwrap_or((seconds, "0"));
    let unix_s: u64 = whole.parse().ok().filter(|unix_s| TIMES_S.contains(unix_s))?;
    let digits = u32::try_from(fraction.len()).ok().filter(|digits| (1..=6).contains(digits))?;
    let fraction_us = fraction.parse::<u32>().ok()? * 10_u32.pow(6 - digits);
    let error_us = at.map_or(Some(TYPED_ERROR_US), |(_, error_us)| error_us.parse().ok())?;
    let stamp_us = match at {
        Some((stamp_us, _)) => Some(stamp_us.parse().ok()?),
        None => None,
    };
    let time = UnixTime { unix_us: unix_s * 1_000_000 + u64::from(fraction_us), error_us };
    Some(Command::TimeSet { time, stamp_us })
}

fn named(name: &str) -> Result<Parameter, CommandError> {
    Parameter::named(name).ok_or_else(|| CommandError::UnknownSetting(cut(name)))
}

fn cut(word: &str) -> Word {
    let end = word.floor_char_boundary(Word::new().capacity());
    Word::try_from(word.get(..end).unwrap_or_default()).unwrap_or_default()
}
