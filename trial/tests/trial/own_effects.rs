//! Effects that a user wrote, in a trial: drawn, hidden, and told with their parameters.
use towmag_trial::{Answer, BlindTrial, Kind, OwnEffect, TrialOptions};

fn own(formula: &str, kind: &str, more: &str) -> OwnEffect {
    let text = format!(
        "name = \"mine\"\nchannel = \"scalar\"\nkind = \"{kind}\"\nformula = \"{formula}\"\n\
         [parameters.g]\nlow = -50.0\nhigh = 50.0\ndefault = 1.0\n{more}"
    );
    OwnEffect::read("mine.toml", text).unwrap()
}

fn answers(own: OwnEffect) -> (BlindTrial, Vec<Answer>) {
    let options =
        TrialOptions { recordings: 14, seed: 6, minutes: Some(2.0), own: vec![own], ..TrialOptions::default() };
    let blind = BlindTrial::draw(options, None, || {}).unwrap();
    let answers = serde_json::from_str(blind.answers()).unwrap();
    (blind, answers)
}

#[test]
fn every_single_effect_is_the_users_as_strong_as_asked_and_in_the_recording() {
    let slow = "[parameters.tau]\nlow = 0.5\nhigh = 5.0\ndefault = 1.0\n\
                [inputs.late]\nof = \"dcy\"\nfilter = \"lowpass\"\ntime_s = \"tau\"\n";
    let (blind, answers) = answers(own("g * late * cz", "additive", slow));
    let singles: Vec<&Answer> = answers.iter().filter(|answer| answer.kind == Kind::Single).collect();
    assert!(singles.len() >= 2, "{}", singles.len());
    for single in &singles {
        let [hidden] = &single.hidden[..] else { panic!("{single:?}") };
        assert!(hidden.name == "mine" && (0.7..13.0).contains(&hidden.strength), "{hidden:?}");
        assert!(hidden.parameters["g"].abs() <= 50.0 && (0.5..=5.0).contains(&hidden.parameters["tau"]), "{hidden:?}");
    }
    let told = std::sync::Mutex::new(0);
    let count = |_: usize, csv: &str| -> Result<(), towmag_trial::TrialError> {
        *told.lock().unwrap() += usize::from(csv.lines().count() > 900);
        Ok(())
    };
    blind.recordings(count).unwrap();
    assert_eq!(*told.lock().unwrap(), answers.len());
}

#[test]
fn what_no_recording_of_a_trial_has_is_refused() {
    let text = |formula: &str| {
        format!("name = \"mine\"\nchannel = \"scalar\"\nkind = \"additive\"\nformula = \"{formula}\"\n")
    };
    let refused = |text: String| OwnEffect::read("mine.toml", text).unwrap_err().to_string();
    assert!(refused(text("winch_rpm")).contains("needs the column winch_rpm, which no recording of a trial has"));
    assert!(refused(text("cx +")).contains("mine.toml: line 4"));
    assert!(refused(text("cx").replace("mine", "scalar_lag")).contains("the name scalar_lag is taken"));
}
