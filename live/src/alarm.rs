//! Alarms: each sounds from the moment that something is wrong until a person has said so, even if it is over by then.

use serde::Serialize;

/// What there is an alarm for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AlarmKind {
    /// No usable reading.
    Sensor,
    /// The body does not log.
    Log,
    /// The body is too close to the bottom.
    Altitude,
    /// There is water in the body.
    Leak,
    /// Nothing comes up the cable.
    Cable,
    /// A target was passed.
    Target,
}

const KINDS: [AlarmKind; 6] =
    [AlarmKind::Sensor, AlarmKind::Log, AlarmKind::Altitude, AlarmKind::Leak, AlarmKind::Cable, AlarmKind::Target];

impl AlarmKind {
    /// How long it must last before it sounds, s. The band-pass holds through a dropout of 1 s; one reading of an
    /// altimeter that looks at a fish or at its own bubbles is none; the body's messages come ten a second, and a radio
    /// modem holds some back for a second.
    fn patience_s(self) -> f64 {
        match self {
            Self::Sensor | Self::Log | Self::Altitude => 1.0,
            Self::Cable => 2.0,
            Self::Leak | Self::Target => 0.0,
        }
    }

    /// Its name on the wire.
    pub(crate) fn parse(name: &str) -> Option<Self> {
        KINDS.into_iter().find(|kind| kind.name() == name)
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Sensor => "sensor",
            Self::Log => "log",
            Self::Altitude => "altitude",
            Self::Leak => "leak",
            Self::Cable => "cable",
            Self::Target => "target",
        }
    }
}

/// One alarm, as a page shows it: those that are quiet are not.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Alarm {
    pub(crate) kind: AlarmKind,
    /// What is wrong.
    pub(crate) text: String,
    /// Since when, s, on the strip.
    pub(crate) since_s: f64,
    /// Whether a person has seen it: then it is silent.
    pub(crate) is_acknowledged: bool,
    /// Whether it is past.
    pub(crate) is_over: bool,
}

/// All alarms that are not quiet, and what may become one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Alarms {
    alarms: Vec<Alarm>,
    /// Since when something is wrong, s, one an alarm.
    wrong_since_s: [Option<f64>; KINDS.len()],
}

impl Alarms {
    /// Something is wrong, or is not, at a time of any one clock, s; `text` says what. Whether that changes anything.
    pub(crate) fn watch(
        &mut self,
        kind: AlarmKind,
        is_wrong: bool,
        clock_s: f64,
        time_s: f64,
        text: impl Fn() -> String,
    ) -> bool {
        let since = &mut self.wrong_since_s[kind as usize];
        if !is_wrong {
            return since.take().is_some() && self.end(kind);
        }
        let since_s = *since.get_or_insert(clock_s);
        clock_s - since_s >= kind.patience_s() && self.begin(kind, time_s, text)
    }

    /// Something has happened that is over at once. `text` says what.
    pub(crate) fn ring(&mut self, kind: AlarmKind, time_s: f64, text: String) {
        self.alarms.retain(|alarm| alarm.kind != kind);
        self.alarms.push(Alarm { kind, text, since_s: time_s, is_acknowledged: false, is_over: true });
    }

    /// A person has seen it. Its text, where that is news.
    pub(crate) fn acknowledge(&mut self, kind: AlarmKind) -> Option<String> {
        let alarm = self.alarms.iter_mut().find(|alarm| alarm.kind == kind && !alarm.is_acknowledged)?;
        alarm.is_acknowledged = true;
        let text = alarm.text.clone();
        self.forget();
        Some(text)
    }

    /// Those that are not quiet.
    pub(crate) fn all(&self) -> &[Alarm] {
        &self.alarms
    }

    fn begin(&mut self, kind: AlarmKind, time_s: f64, text: impl Fn() -> String) -> bool {
        match self.alarms.iter_mut().find(|alarm| alarm.kind == kind) {
            Some(alarm) if !alarm.is_over => return false,
            // Once more before anybody has seen the first: the first counts.
            Some(alarm) => alarm.is_over = false,
            None => {
                self.alarms.push(Alarm { kind, text: text(), since_s: time_s, is_acknowledged: false, is_over: false })
            }
        }
        true
    }

    fn end(&mut self, kind: AlarmKind) -> bool {
        let Some(alarm) = self.alarms.iter_mut().find(|alarm| alarm.kind == kind && !alarm.is_over) else {
            return false;
        };
        alarm.is_over = true;
        self.forget();
        true
    }

    fn forget(&mut self) {
        self.alarms.retain(|alarm| !(alarm.is_over && alarm.is_acknowledged));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn states(alarms: &Alarms) -> Vec<(bool, bool)> {
        alarms.all().iter().map(|alarm| (alarm.is_acknowledged, alarm.is_over)).collect()
    }

    fn watched(alarms: &mut Alarms, is_wrong: bool, clock_s: f64) -> bool {
        alarms.watch(AlarmKind::Sensor, is_wrong, clock_s, clock_s, || "no scalar".into())
    }

    #[test]
    fn it_sounds_when_it_lasts_and_until_it_is_over_and_seen() {
        let mut alarms = Alarms::default();
        assert!(!watched(&mut alarms, true, 10.0) && !watched(&mut alarms, true, 10.9) && alarms.all().is_empty());
        assert!(!watched(&mut alarms, false, 10.95) && !watched(&mut alarms, true, 11.0));
        assert!(watched(&mut alarms, true, 12.0), "a second from the second time on");
        assert_eq!(states(&alarms), [(false, false)]);
        assert!(!watched(&mut alarms, true, 12.1), "no news");
        assert!(watched(&mut alarms, false, 13.0));
        assert_eq!(states(&alarms), [(false, true)], "nobody has seen it");
        assert_eq!(alarms.acknowledge(AlarmKind::Log), None);
        assert_eq!(alarms.acknowledge(AlarmKind::Sensor).as_deref(), Some("no scalar"));
        assert!(alarms.all().is_empty());
    }

    #[test]
    fn what_is_seen_is_silent_while_it_lasts_and_sounds_the_next_time() {
        let mut alarms = Alarms::default();
        assert!(!watched(&mut alarms, true, 0.0) && watched(&mut alarms, true, 1.0));
        assert!(alarms.acknowledge(AlarmKind::Sensor).is_some() && alarms.acknowledge(AlarmKind::Sensor).is_none());
        assert_eq!(states(&alarms), [(true, false)]);
        assert!(!watched(&mut alarms, true, 5.0) && watched(&mut alarms, false, 6.0));
        assert!(alarms.all().is_empty());
        assert!(!watched(&mut alarms, true, 7.0) && watched(&mut alarms, true, 8.0));
        assert_eq!(states(&alarms), [(false, false)]);
    }

    #[test]
    fn a_second_target_rings_again() {
        let mut alarms = Alarms::default();
        alarms.ring(AlarmKind::Target, 3.0, "one".into());
        alarms.ring(AlarmKind::Target, 9.0, "two".into());
        assert_eq!(alarms.all().len(), 1);
        assert_eq!(alarms.acknowledge(AlarmKind::Target).as_deref(), Some("two"));
        assert!(alarms.all().is_empty());
    }

    #[test]
    fn every_kind_has_a_name_of_its_own() {
        assert!(
            KINDS
                .into_iter()
                .enumerate()
                .all(|(place, kind)| kind as usize == place && AlarmKind::parse(kind.name()) == Some(kind))
        );
        assert_eq!(AlarmKind::parse("rum"), None);
    }
}
