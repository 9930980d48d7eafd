//! What an operator can tell the body.

use super::frame::MAX_BODY;
use crate::store::{Parameter, ValueText};

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
    /// `set name value`.
    Set {
        /// Which.
        parameter: Parameter,
        /// To what, as typed.
        value: ValueText,
    },
    /// `calibrate start|stop|accept|discard`.
    Calibrate(Calibrate),
    /// `log start` (true) or `log stop`.
    Log(bool),
    /// `time set unix_s`.
    TimeSet {
        /// Seconds since 1970-01-01 UTC, within the years 2020 to 2099.
        unix_s: u64,
    },
    /// `help`: the commands.
    Help,
    /// `reset`: start anew, with the stored settings.
    Reset,
}

/// The steps of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibrate {
    /// Begin to record.
    Start,
    /// End and solve.
    Stop,
    /// Keep the result.
    Accept,
    /// Give it up.
    Discard,
}

/// What `help` answers, line by line.
pub const HELP: [&str; 10] = [
    "status                         how the body is, and every fault counter that is not zero",
    "get [name]                     all settings, or one",
    "set name value                 change a setting and store it; but for log, it holds from the next start",
    "calibrate start                begin to record; then roll, pitch and yaw on four headings",
    "calibrate stop                 end and solve: improvement ratio, condition number, coefficients",
    "calibrate accept | discard     keep the coefficients and start anew with them, or not",
    "log start | stop               epochs to the card; holds beyond a restart",
    "time set seconds               seconds since 1970-01-01 UTC",
    "reset                          start anew with the stored settings",
    "help                           these lines",
];

/// First second of 2020 and of 2100: milliseconds and slips of the finger lie outside.
const TIMES_S: core::ops::Range<u64> = 1_577_836_800..4_102_444_800;

/// Why a line is no command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommandError {
    /// No command has this name.
    Unknown(Word),
    /// No setting has this name.
    UnknownSetting(Word),
    /// A known command, but not like this; how it is written.
    Usage(&'static str),
}

impl core::fmt::Display for CommandError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unknown(word) => write!(f, "error: no command \"{word}\": type help"),
            Self::UnknownSetting(word) => write!(f, "error: no setting \"{word}\": type get for all of them"),
            Self::Usage(usage) => write!(f, "error: type {usage}"),
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
    } else if is("calibrate") {
        calibrate(words)
    } else if is("log") {
        log(words)
    } else if is("time") {
        time(words)
    } else if is("help") || is("?") {
        alone(Command::Help, words, "help")
    } else if is("reset") {
        alone(Command::Reset, words, "reset")
    } else {
        Err(CommandError::Unknown(cut(command)))
    }
}

/// The words after the first; of the last only matters whether there is one.
type Rest<'a> = [Option<&'a str>; 3];

fn alone(command: Command, rest: Rest<'_>, usage: &'static str) -> Result<Command, CommandError> {
    if rest == [None; 3] { Ok(command) } else { Err(CommandError::Usage(usage)) }
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

fn calibrate(rest: Rest<'_>) -> Result<Command, CommandError> {
    let steps = [
        ("start", Calibrate::Start),
        ("stop", Calibrate::Stop),
        ("accept", Calibrate::Accept),
        ("discard", Calibrate::Discard),
    ];
    let step = choose(rest, &steps).ok_or(CommandError::Usage("calibrate start, stop, accept or discard"))?;
    Ok(Command::Calibrate(step))
}

fn log(rest: Rest<'_>) -> Result<Command, CommandError> {
    let on = choose(rest, &[("start", true), ("stop", false)]).ok_or(CommandError::Usage("log start or log stop"))?;
    Ok(Command::Log(on))
}

fn time(rest: Rest<'_>) -> Result<Command, CommandError> {
    let seconds = match rest {
        [Some(set), Some(seconds), None] if set.eq_ignore_ascii_case("set") => seconds.parse().ok(),
        _ => None,
    };
    let unix_s = seconds.filter(|seconds| TIMES_S.contains(seconds));
    let unix_s =
        unix_s.ok_or(CommandError::Usage("time set seconds, since 1970-01-01 UTC, of the years 2020 to 2099"))?;
    Ok(Command::TimeSet { unix_s })
}

/// The meaning of a single word.
fn choose<T: Copy>(rest: Rest<'_>, choices: &[(&str, T)]) -> Option<T> {
    let [Some(word), None, _] = rest else { return None };
    choices.iter().find(|(name, _)| word.eq_ignore_ascii_case(name)).map(|(_, meaning)| *meaning)
}

fn named(name: &str) -> Result<Parameter, CommandError> {
    Parameter::named(name).ok_or_else(|| CommandError::UnknownSetting(cut(name)))
}

fn cut(word: &str) -> Word {
    let end = word.floor_char_boundary(Word::new().capacity());
    Word::try_from(word.get(..end).unwrap_or_default()).unwrap_or_default()
}
