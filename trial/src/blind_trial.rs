//! The course of a trial: draw and seal, have every recording diagnosed, open and score.

use rayon::prelude::*;

use crate::answer::{Answer, Kind};
use crate::error::TrialError;
use crate::options::TrialOptions;
use crate::outcome::{Trial, Untouched};
use crate::real::RealRecording;
use crate::reply::{Reply, TrialResult};
use crate::request::Request;
use crate::seal::Sealed;
use crate::{real, synthetic};

/// A trial whose answers are drawn and sealed.
pub struct BlindTrial {
    options: TrialOptions,
    real: Option<RealRecording>,
    sealed: Sealed,
    recording_count: usize,
}

impl BlindTrial {
    /// Draw the answers and seal them; with a real recording, of effects that are put into it. `drawn` is told after each.
    ///
    /// # Errors
    ///
    /// When the options ask for what cannot be tried.
    pub fn draw(
        options: TrialOptions,
        real: Option<RealRecording>,
        drawn: impl Fn() + Sync,
    ) -> Result<Self, TrialError> {
        options.check()?;
        let one = |index| {
            let answer = match &real {
                Some(real) => real::answer(&options, real, index),
                None => Some(synthetic::answer(&options, index)),
            };
            drawn();
            answer
        };
        let answers: Vec<Answer> = options.indices().into_par_iter().filter_map(one).collect();
        Ok(Self { sealed: Sealed::of(&answers), recording_count: answers.len(), options, real })
    }

    /// What `answers.json` holds.
    pub fn answers(&self) -> &str {
        &self.sealed.answers
    }

    /// SHA-256 of [`Self::answers`], hexadecimal.
    pub fn sha256(&self) -> &str {
        &self.sealed.sha256
    }

    /// How many recordings there are: as many as were asked for, of a part its own, or fewer where an effect would not show in a real one.
    pub fn recording_count(&self) -> usize {
        self.recording_count
    }

    /// What can be told while the answers are sealed.
    pub fn unopened(&self) -> Trial {
        Trial::unopened(&self.options, &self.sealed)
    }

    /// Every recording as CSV: number and text go to `keep`, several at a time.
    ///
    /// # Errors
    ///
    /// Those of `keep`.
    pub fn recordings<E: From<TrialError> + Send>(
        &self,
        keep: impl Fn(usize, &str) -> Result<(), E> + Sync,
    ) -> Result<(), E> {
        self.sealed.open()?.par_iter().try_for_each(|answer| keep(answer.index, &self.recording(answer)))
    }

    /// The same of the next tow of each body that hides one effect of the library: it hides the same.
    ///
    /// # Errors
    ///
    /// Those of `keep`.
    pub fn next_recordings<E: From<TrialError> + Send>(
        &self,
        keep: impl Fn(usize, &str) -> Result<(), E> + Sync,
    ) -> Result<(), E> {
        let next = |answer: &Answer| self.next_recording(answer).map_or(Ok(()), |next| keep(answer.index, &next));
        self.sealed.open()?.par_iter().try_for_each(next)
    }

    /// Have every recording diagnosed, several at a time; of a trial on a real recording, that one first, untouched.
    /// Then open the answers and score what was said. `diagnosed` is told after each recording.
    ///
    /// `diagnose` returns the text of a `diagnosis.json`.
    ///
    /// # Errors
    ///
    /// Those of `diagnose`, and when what it returns is no `diagnosis.json`.
    pub fn run<E: From<TrialError> + Send>(
        &self,
        diagnose: impl Fn(&Request<'_>) -> Result<String, E> + Sync,
        diagnosed: impl Fn() + Sync,
    ) -> Result<Trial, E> {
        let ask = |request: &Request<'_>| -> Result<Reply, E> { Ok(Reply::read(request.name, diagnose(request)?)?) };
        let untouched = |real: &RealRecording| -> Result<Untouched, E> {
            Ok((real.residual_rms_nt(), ask(&self.request(real.name(), real.csv()))?))
        };
        let untouched = self.real.as_ref().map(untouched).transpose()?;
        let result = |answer| self.result(answer, &ask).inspect(|_| diagnosed());
        let results = self.sealed.open()?.par_iter().map(result).collect::<Result<Vec<TrialResult>, E>>()?;
        Ok(Trial::opened(&self.options, &self.sealed, untouched, results)?)
    }

    /// The recording is made here and forgotten: only its text reaches the diagnosis.
    fn result<E>(&self, answer: &Answer, ask: &impl Fn(&Request<'_>) -> Result<Reply, E>) -> Result<TrialResult, E> {
        let (name, recording) = (format!("recording {}", answer.index), self.recording(answer));
        let simulation = self.options.simulated.then(|| synthetic::simulation(&self.options, answer));
        let request = Request { simulation: simulation.as_deref(), ..self.request(&name, &recording) };
        let second = self.next_recording(answer);
        let diagnosis = ask(&Request { confirm: second.as_deref(), ..request })?;
        let is_withheld = |name: &String| answer.hidden.iter().any(|hidden| hidden.name == *name);
        let has = self.real.is_none() && self.options.withhold.as_ref().is_some_and(is_withheld);
        let put_back = has.then(|| ask(&Request { withheld: &[], ..request })).transpose()?;
        Ok(TrialResult { diagnosis, put_back })
    }

    /// It shows how far the gap really shrinks: where a single effect is right, whatever the first recording says.
    fn next_recording(&self, answer: &Answer) -> Option<String> {
        let is_single = answer.kind == Kind::Single && self.real.is_none();
        is_single.then(|| synthetic::other_recording(&self.options, answer))
    }

    fn recording(&self, answer: &Answer) -> String {
        match &self.real {
            Some(real) => real::injected(&self.options, real, answer),
            None => synthetic::recording(&self.options, answer),
        }
    }

    fn request<'a>(&'a self, name: &'a str, recording: &'a str) -> Request<'a> {
        let withheld = self.options.withhold.as_slice();
        Request { name, recording, confirm: None, simulation: None, withheld, seed: self.options.seed }
    }
}
