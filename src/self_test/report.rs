//! The self-test's result, line by line.

use super::{Due, LOOP_BYTES};
use crate::health::{CardCheck, ConverterCheck};
use crate::log::ResetCause;
use crate::microcontroller::ClockCheck;
use crate::sensors::grid::{FluxMark, ScalarMark};
use core::fmt::{Result, Write};

/// A card may be busy for so long (Physical Layer Specification 4.6.2), microseconds.
const LONGEST_WRITE_US: u32 = 500_000;

/// How the settings' flash reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashCheck {
    /// What holds is what it reads as, its CRC included.
    Intact,
    /// Nothing was stored yet.
    Fresh,
    /// It reads as something else, or not at all.
    Differs,
}

impl From<Option<bool>> for FlashCheck {
    /// Of [`is_intact`](crate::store::SettingsInFlash::is_intact).
    fn from(is_intact: Option<bool>) -> Self {
        match is_intact {
            None => Self::Fresh,
            Some(true) => Self::Intact,
            Some(false) => Self::Differs,
        }
    }
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfTestReport {
    /// What it was made for.
    pub due: Due,
    /// The oscillators at the start.
    pub clock: ClockCheck,
    /// The fluxgate's converter.
    pub converter: ConverterCheck,
    /// The fluxgate's reading of the latest epoch.
    pub flux: FluxMark,
    /// The scalar reading of the latest epoch.
    pub scalar: ScalarMark,
    /// The card.
    pub card: CardCheck,
    /// Whether epochs are to go to the card.
    pub is_logging_wanted: bool,
    /// The settings.
    pub flash: FlashCheck,
    /// Why the body has started.
    pub reset: ResetCause,
    /// Panics, hard faults and resets by the watchdog since power came.
    pub restarts_by_fault: u32,
}

/// A part of the body that is tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Crystal,
    Converter,
    Fluxgate,
    Scalar,
    Card,
    Settings,
    Restarts,
}

const PARTS: [Part; 7] =
    [Part::Crystal, Part::Converter, Part::Fluxgate, Part::Scalar, Part::Card, Part::Settings, Part::Restarts];

impl Part {
    fn name(self) -> &'static str {
        match self {
            Self::Crystal => "crystal",
            Self::Converter => "converter",
            Self::Fluxgate => "fluxgate",
            Self::Scalar => "scalar sensor",
            Self::Card => "card",
            Self::Settings => "settings",
            Self::Restarts => "restarts",
        }
    }
}

impl SelfTestReport {
    /// Line `number`, counted from 0; `None` after the last. At the start only the first, and what has failed.
    pub fn put(&self, line: &mut impl Write, number: usize) -> Option<Result> {
        if number == 0 {
            return Some(self.put_summary(line));
        }
        let mut shown = PARTS.into_iter().filter(|part| self.due != Due::Start || !self.has_passed(*part));
        match (shown.nth(number - 1), self.due) {
            (Some(part), _) => Some(self.put_part(line, part)),
            (None, Due::Asked(came_back)) if number == PARTS.len() + 1 => Some(put_loop(line, came_back)),
            _ => None,
        }
    }

    /// Whether it passed, and what did not.
    pub fn put_summary(&self, line: &mut impl Write) -> Result {
        let mut failed = PARTS.into_iter().filter(|part| !self.has_passed(*part));
        let Some(first) = failed.next() else { return line.write_str("self-test: passed") };
        write!(line, "self-test: failed: {}", first.name())?;
        failed.try_for_each(|part| write!(line, ", {}", part.name()))
    }

    fn has_passed(&self, part: Part) -> bool {
        match part {
            Part::Crystal => self.clock.fault.is_none(),
            Part::Converter => matches!(self.converter, ConverterCheck::Passed { .. }),
            Part::Fluxgate => self.flux == FluxMark::Present,
            Part::Scalar => self.scalar == ScalarMark::Present,
            Part::Card => {
                !self.is_logging_wanted || self.card.blocks > 0 && self.card.slowest_write_us <= LONGEST_WRITE_US
            }
            Part::Settings => self.flash != FlashCheck::Differs,
            Part::Restarts => self.restarts_by_fault == 0,
        }
    }

    fn put_part(&self, line: &mut impl Write, part: Part) -> Result {
        let verdict = if self.has_passed(part) { "ok  " } else { "FAIL" };
        write!(line, "{verdict} {}: ", part.name())?;
        match part {
            Part::Crystal => self.put_crystal(line),
            Part::Converter => self.put_converter(line),
            Part::Fluxgate => line.write_str(match self.flux {
                FluxMark::Present => "reads",
                FluxMark::Missing => "no conversion: look at DRDY and at its clock",
                FluxMark::Clipped => "beyond its range: look at its supply and its divider",
            }),
            Part::Scalar => line.write_str(match self.scalar {
                ScalarMark::Present => "reads",
                ScalarMark::Missing => "silent: look at its supply, at the cable, at scalar_baud and scalar_format",
                ScalarMark::Invalid => "sends, but nothing valid: turn it, or look at its limits",
                ScalarMark::OffTime => "sends at the wrong times: look at latency_us",
            }),
            Part::Card => self.put_card(line),
            Part::Settings => line.write_str(match self.flash {
                FlashCheck::Intact => "intact",
                FlashCheck::Fresh => "none stored yet",
                FlashCheck::Differs => "the flash reads otherwise: type save and try again",
            }),
            Part::Restarts => {
                write!(
                    line,
                    "{} by fault or watchdog since power came; last start by {}",
                    self.restarts_by_fault, self.reset
                )
            }
        }
    }

    fn put_crystal(&self, line: &mut impl Write) -> Result {
        let ClockCheck { fault, crystal_khz, low_speed_hz } = self.clock;
        match (fault, crystal_khz) {
            (Some(fault), _) => {
                fault.put_reason(line)?;
                line.write_str(": look at it and its capacitors")
            }
            (None, 0) => line.write_str("not measured on this board"),
            (None, khz) => {
                write!(line, "{khz} kHz by the internal oscillator (+-8 %); slow oscillator {low_speed_hz} Hz")
            }
        }
    }

    fn put_converter(&self, line: &mut impl Write) -> Result {
        match self.converter {
            ConverterCheck::NotTried => line.write_str("not asked yet"),
            ConverterCheck::Passed { id } => write!(line, "answers with a right CRC, identity {id:04X}"),
            ConverterCheck::NoAnswer { response } => {
                write!(line, "answers a reset with {response:04X} instead of FF24: look at its wires, supply and clock")
            }
            ConverterCheck::OtherChip { id } => write!(line, "identity {id:04X}, which is no ADS131M04"),
            ConverterCheck::Damaged => line.write_str("nothing, or rubbish: look at its wires and supply"),
            ConverterCheck::Refuses => line.write_str("does not keep its settings"),
            ConverterCheck::Bus => line.write_str("the bus failed"),
        }
    }

    fn put_card(&self, line: &mut impl Write) -> Result {
        let CardCheck { blocks, writes, slowest_write_us } = self.card;
        match (self.is_logging_wanted, blocks) {
            (false, _) => line.write_str("the log is off"),
            (true, 0) => line.write_str("none, or it does not answer, or has no room for a log"),
            (true, blocks) => {
                let (mb, slowest_ms) = (blocks / 1_953, slowest_write_us.div_ceil(1_000));
                write!(line, "{mb} MB, {writes} writes, the slowest {slowest_ms} ms (500 at most)")
            }
        }
    }
}

fn put_loop(line: &mut impl Write, [scalar, nmea]: [u8; 2]) -> Result {
    if [scalar, nmea] == [0; 2] {
        return line.write_str("wire test: nothing came back (join TX and RX in place of a sensor, and ask again)");
    }
    write!(line, "wire test: {scalar} of {LOOP_BYTES} bytes came back on scalar, {nmea} on nmea")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::MAX_BODY;
    use crate::microcontroller::ClockFault;
    use heapless::String;

    fn good(due: Due) -> SelfTestReport {
        SelfTestReport {
            due,
            clock: ClockCheck { fault: None, crystal_khz: 8_000, low_speed_hz: 32_000 },
            converter: ConverterCheck::Passed { id: 0x2403 },
            flux: FluxMark::Present,
            scalar: ScalarMark::Present,
            card: CardCheck { blocks: 31_116_288, writes: 12, slowest_write_us: 41_000 },
            is_logging_wanted: true,
            flash: FlashCheck::Intact,
            reset: ResetCause::PowerOn,
            restarts_by_fault: 0,
        }
    }

    fn lines(report: &SelfTestReport) -> impl Iterator<Item = String<300>> {
        (0..).map_while(|number| {
            let mut line = String::new();
            report.put(&mut line, number).map(|written| written.map(|()| line).unwrap())
        })
    }

    #[test]
    fn a_body_that_is_well_says_so_in_one_line() {
        assert!(lines(&good(Due::Start)).eq(["self-test: passed"]));
        let report = good(Due::Asked([8, 0]));
        let mut asked = lines(&report);
        assert_eq!(asked.next().unwrap(), "self-test: passed");
        assert_eq!(asked.nth(4).unwrap(), "ok   card: 15932 MB, 12 writes, the slowest 41 ms (500 at most)");
        assert_eq!(asked.nth(2).unwrap(), "wire test: 8 of 8 bytes came back on scalar, 0 on nmea");
        assert_eq!(asked.next(), None);
    }

    #[test]
    fn a_card_that_stalls_fails() {
        let mut report = good(Due::Start);
        report.card.slowest_write_us = 500_001;
        assert_eq!(lines(&report).next().unwrap(), "self-test: failed: card");
    }

    #[test]
    fn the_longest_lines_fit_into_a_frame() {
        for converter in [ConverterCheck::NoAnswer { response: 0xFFFF }, ConverterCheck::Damaged] {
            let report = SelfTestReport {
                clock: ClockCheck { fault: Some(ClockFault::WrongFrequency { khz: 99_999 }), ..ClockCheck::default() },
                converter,
                flux: FluxMark::Clipped,
                scalar: ScalarMark::Missing,
                card: CardCheck { blocks: u32::MAX, writes: u32::MAX, slowest_write_us: u32::MAX },
                flash: FlashCheck::Differs,
                reset: ResetCause::BrownOut,
                restarts_by_fault: u32::MAX,
                ..good(Due::Asked([0; 2]))
            };
            for line in lines(&report) {
                assert!(line.len() <= MAX_BODY, "{line}: {}", line.len());
            }
            assert_eq!(lines(&report).count(), 9);
        }
    }
}
