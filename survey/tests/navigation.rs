//! Tracks from columns as recorders write them.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use towmag_survey::Tow;
use towmag_survey::navigation::{Grid, Layback, NavigationError, NavigationOptions, PositionOf, navigate};

/// Where the tow starts, on its grid.
const START: [f64; 2] = [597_000.0, 6_017_000.0];

fn grid() -> Grid {
    Grid::of(54.3, 10.5).unwrap()
}

/// Two legs of 400 m and the half circle of 30 m between them, at 2 m/s: after so many metres.
fn place(way_m: f64) -> [f64; 2] {
    let turn_m = std::f64::consts::PI * 30.0;
    let [x, y] = match way_m {
        way if way < 400.0 => [0.0, way],
        way if way < 400.0 + turn_m => {
            let angle = (way - 400.0) / 30.0;
            [30.0 - 30.0 * angle.cos(), 400.0 + 30.0 * angle.sin()]
        }
        way => [60.0, 800.0 + turn_m - way],
    };
    [START[0] + x, START[1] + y]
}

/// The tow at 10 Hz, with positions as `given` makes them of the row.
fn tow(given: impl Fn(usize) -> Option<[f64; 2]>) -> Tow {
    let rows = 4400;
    let degrees = |row| given(row).map_or([f64::NAN; 2], |[x, y]| grid().geographic(x, y).unwrap());
    let positions: Vec<[f64; 2]> = (0..rows).map(degrees).collect();
    Tow {
        name: "rec.csv".into(),
        time_s: (0..rows).map(|row| row as f64 / 10.0).collect(),
        is_usable: vec![true; rows],
        scalar_nt: vec![50_000.0; rows],
        flux_nt: vec![[20_000.0, 0.0, 45_000.0]; rows],
        latitude_deg: Some(positions.iter().map(|degrees| degrees[0]).collect()),
        longitude_deg: Some(positions.iter().map(|degrees| degrees[1]).collect()),
        ..Tow::default()
    }
}

fn at(row: usize) -> [f64; 2] {
    place(0.2 * row as f64)
}

/// How far the track is off these places at worst, m, from the second second to the last but one.
fn off_m(tow: &Tow, options: &NavigationOptions, truth: impl Fn(usize) -> [f64; 2]) -> f64 {
    let navigation = navigate(std::slice::from_ref(tow), options).unwrap();
    assert_eq!(navigation.grid.unwrap().epsg(), 32632);
    let track = navigation.tows[0].track.as_ref().unwrap();
    let off = |row: usize| (track.easting_m[row] - truth(row)[0]).hypot(track.northing_m[row] - truth(row)[1]);
    (20..tow.len() - 20).map(off).fold(0.0, f64::max)
}

#[test]
fn a_receiver_of_1_hz_is_followed_whatever_the_recorder_does_between() {
    let body = NavigationOptions::default();
    let missing = tow(|row| (row % 10 == 0).then(|| at(row)));
    let held = tow(|row| Some(at(row - row % 10)));
    assert!(off_m(&missing, &body, at) < 0.1, "{}", off_m(&missing, &body, at));
    assert!(off_m(&held, &body, at) < 0.1, "{}", off_m(&held, &body, at));
    let navigated = navigate(&[held], &body).unwrap().tows.remove(0);
    assert_eq!((navigated.fixes, navigated.dropped_fixes), (440, 0));
    let slow = tow(|row| (row % 150 == 0).then(|| at(row)));
    assert!(off_m(&slow, &body, at).is_finite() && off_m(&slow, &body, at) < 8.0, "{}", off_m(&slow, &body, at));
}

#[test]
fn what_a_receiver_makes_up_is_dropped_and_counted() {
    let mut tow = tow(|row| {
        let [x, y] = at(row);
        (row % 10 == 0).then_some(if [500, 510, 3000].contains(&row) { [x + 40.0, y - 15.0] } else { [x, y] })
    });
    for (row, place) in [(0, [0.0, 0.0]), (1000, [54.3, 400.0])] {
        tow.latitude_deg.as_mut().unwrap()[row] = place[0];
        tow.longitude_deg.as_mut().unwrap()[row] = place[1];
    }
    assert_eq!(navigate(std::slice::from_ref(&tow), &NavigationOptions::default()).unwrap().tows[0].dropped_fixes, 5);
    assert!(off_m(&tow, &NavigationOptions::default(), at) < 0.2);
}

#[test]
fn what_a_receiver_that_hangs_repeats_is_no_position() {
    let tow = tow(|row| Some(at(if (1500..3500).contains(&row) { 1500 } else { row - row % 10 })));
    let navigated = navigate(&[tow], &NavigationOptions::default()).unwrap().tows.remove(0);
    // One a second, but for the 200 s in which it hangs, of which the first is one.
    assert_eq!(navigated.fixes, 241);
    assert!(navigated.dropped_fixes > 100, "{}", navigated.dropped_fixes);
    let east_m = navigated.track.unwrap().easting_m;
    assert!(east_m[1400].is_finite() && !east_m[2500].is_finite() && east_m[3600].is_finite());
}

#[test]
fn late_positions_are_put_back() {
    let late = tow(|row| (row % 5 == 0).then(|| at(row.saturating_sub(13))));
    let options = NavigationOptions { lag_s: 1.3, ..NavigationOptions::default() };
    assert!(off_m(&late, &options, at) < 0.1, "{}", off_m(&late, &options, at));
    assert!(off_m(&late, &NavigationOptions::default(), at) > 2.0);
}

#[test]
fn the_body_is_in_the_ships_wake() {
    let mut ship = tow(|row| Some(at(row)));
    ship.cable_out_m = Some(vec![50.0; ship.len()]);
    let swell = |row: usize| 30.0 + 0.3 * (row as f64 * 0.1).sin();
    ship.depth_m = Some((0..ship.len()).map(swell).collect());
    let options = |layback, tow_point_m| NavigationOptions {
        position: PositionOf::Ship { layback, tow_point_m },
        ..NavigationOptions::default()
    };
    let behind = |metres: f64| move |row: usize| place(0.2 * row as f64 - metres);
    for (options, metres) in [
        (options(Layback::Cable(1.0), 0.0), 40.0),
        (options(Layback::Cable(0.9), 10.0), 46.0),
        (options(Layback::Fixed(25.0), 0.0), 25.0),
    ] {
        assert!(off_m(&ship, &options, behind(metres)) < 0.3, "{}", off_m(&ship, &options, behind(metres)));
    }
    ship.cable_out_m = None;
    let said = navigate(&[ship], &options(Layback::Cable(1.0), 0.0)).unwrap_err();
    assert!(matches!(said, NavigationError::NoLayback { lacking: "cable_out_m", .. }), "{said}");
}

#[test]
fn the_track_tells_way_speed_course_and_lines() {
    let navigation = navigate(&[tow(|row| Some(at(row)))], &NavigationOptions::default()).unwrap();
    let navigated = &navigation.tows[0];
    let track = navigated.track.as_ref().unwrap();
    assert!((track.along_m[4000] - 800.0).abs() < 0.5 && track.along_m.is_sorted(), "{}", track.along_m[4000]);
    assert!(track.speed_m_per_s[30..4370].iter().all(|speed| (speed - 2.0).abs() < 0.05));
    let course = |row: usize| (track.course_deg[row] + 180.0).rem_euclid(360.0) - 180.0;
    assert!(course(1000).abs() < 0.5 && (course(4000).abs() - 180.0).abs() < 0.5);
    let [latitude_deg, longitude_deg] = grid().geographic(at(1000)[0], at(1000)[1]).unwrap();
    assert!((track.latitude_deg[1000] - latitude_deg).abs() < 1e-7);
    assert!((track.longitude_deg[1000] - longitude_deg).abs() < 1e-7);
    assert_eq!([1000, 2300, 4000].map(|row: usize| &*navigated.line[row]), ["L1", "", "L2"]);
}

#[test]
fn without_positions_a_speed_tells_the_way_and_without_it_nothing_does() {
    let none = tow(|_| None);
    let mut speed = none.clone();
    speed.speed_m_per_s = Some((0..speed.len()).map(|row| if row % 20 == 3 { f64::NAN } else { 1.5 }).collect());
    let navigation = navigate(&[speed, none], &NavigationOptions::default()).unwrap();
    assert_eq!(navigation.grid, None);
    let track = navigation.tows[0].track.as_ref().unwrap();
    assert!((track.along_m[4000] - 600.0).abs() < 1e-6 && track.easting_m.iter().all(|metres| metres.is_nan()));
    assert!(navigation.tows[1].track.is_none());
}

#[test]
fn recordings_share_a_grid_and_the_numbers_of_lines() {
    let one = tow(|row| Some(at(row)));
    // 12.2 degrees east is in the next zone.
    let far = Tow { longitude_deg: Some(vec![12.2; 4400]), ..one.clone() };
    let navigation = navigate(&[one.clone(), far, one], &NavigationOptions::default()).unwrap();
    assert_eq!(navigation.grid.unwrap().epsg(), 32632);
    let east_m = navigation.tows[1].track.as_ref().unwrap().easting_m[2000];
    assert!((700_000.0..720_000.0).contains(&east_m), "{east_m}");
    assert_eq!(&*navigation.tows[2].line[4000], "L6");
}

/// Noise of a receiver, of one metre.
fn noise(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}

/// How the recorder fills the rows between two fixes.
#[derive(Clone, Copy, Debug)]
enum Between {
    Nothing,
    /// Straight from fix to fix, as `import` does.
    Led,
}

#[test]
fn receivers_of_any_rate_and_noise_are_smoothed_and_no_good_fix_is_dropped() {
    use Between::{Led, Nothing};
    // Rows between fixes, noise in m, and what may be left of it in m and, of the speed, in m/s.
    for (every, between, noise_m, left_m, left_m_per_s) in [
        (10, Nothing, 0.02, 0.02, 0.02),
        (10, Nothing, 0.5, 0.25, 0.1),
        (10, Nothing, 2.0, 0.75, 0.15),
        (10, Led, 0.02, 0.02, 0.02),
        (10, Led, 0.5, 0.3, 0.1),
        (10, Led, 2.0, 1.0, 0.2),
        (2, Nothing, 0.02, 0.02, 0.02),
        (2, Nothing, 1.0, 0.22, 0.1),
        (1, Nothing, 1.0, 0.18, 0.1),
        (1, Nothing, 3.0, 0.4, 0.15),
    ] {
        for seed in 1..=5 {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let noisy: Vec<[f64; 2]> =
                (0..4410).map(|row| at(row).map(|metres| metres + noise_m * noise(&mut random))).collect();
            let tow = tow(|row| match (row % every, between) {
                (0, _) => Some(noisy[row]),
                (_, Nothing) => None,
                (past, Led) => {
                    let (from, to, share) = (noisy[row - past], noisy[row - past + every], past as f64 / every as f64);
                    Some([0, 1].map(|axis: usize| from[axis] + share * (to[axis] - from[axis])))
                }
            });
            let navigated = navigate(&[tow], &NavigationOptions::default()).unwrap().tows.remove(0);
            let track = navigated.track.unwrap();
            let square = |row: usize| {
                let [x, y] = at(row);
                ((track.easting_m[row] - x).powi(2) + (track.northing_m[row] - y).powi(2)) / 2.0
            };
            let rms = |square: &dyn Fn(usize) -> f64| ((20..4380).map(square).sum::<f64>() / 4360.0).sqrt();
            let (rms_m, rms_m_per_s) = (rms(&square), rms(&|row| (track.speed_m_per_s[row] - 2.0).powi(2)));
            println!(
                "every {every} rows, {between:?} between, noise {noise_m} m: {rms_m:.3} m, {rms_m_per_s:.3} m/s, {} dropped",
                navigated.dropped_fixes
            );
            assert!(rms_m < left_m && rms_m_per_s < left_m_per_s, "{every} {noise_m} {seed}: {rms_m} {rms_m_per_s}");
            assert!(navigated.dropped_fixes <= 1, "{}", navigated.dropped_fixes);
        }
    }
}

#[test]
fn a_hundredth_of_wild_fixes_is_found() {
    for (every, seed) in [(10, 1), (10, 2), (2, 3), (1, 4), (1, 5)] {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let (mut wild, mut places) = (0, Vec::new());
        for row in 0..4400 {
            let is_wild = noise(&mut random).abs() > 2.58 && row % every == 0;
            let far_m = if is_wild { 25.0 } else { 0.0 };
            wild += usize::from(is_wild);
            places.push(at(row).map(|metres| metres + 0.5 * noise(&mut random) + far_m));
        }
        let tow = tow(|row| (row % every == 0).then_some(places[row]));
        let navigation = navigate(std::slice::from_ref(&tow), &NavigationOptions::default()).unwrap();
        assert!(navigation.tows[0].dropped_fixes.abs_diff(wild) <= 1, "{wild}: {}", navigation.tows[0].dropped_fixes);
        assert!(
            off_m(&tow, &NavigationOptions::default(), at) < 2.5,
            "{}",
            off_m(&tow, &NavigationOptions::default(), at)
        );
    }
}
