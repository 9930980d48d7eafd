//! A track over the 180th meridian, cut there: RFC 7946, section 3.1.9. Else a map draws it once around the Earth.

/// The parts of a track of longitudes and latitudes, degrees, each on its side of the 180th meridian; one part for most.
pub fn cut(places: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut parts = vec![places.iter().take(1).copied().collect::<Vec<_>>()];
    for step in places.windows(2) {
        let [from, to] = [step[0], step[1]];
        if let Some((edge, latitude)) = crossing(from, to) {
            if let Some(part) = parts.last_mut() {
                part.push([edge, latitude]);
            }
            parts.push(vec![[-edge, latitude]]);
        }
        if let Some(part) = parts.last_mut() {
            part.push(to);
        }
    }
    parts
}

/// The longitude of the edge that a step leaves over, and the latitude there.
fn crossing(from: [f64; 2], to: [f64; 2]) -> Option<(f64, f64)> {
    if (to[0] - from[0]).abs() <= 180.0 {
        return None;
    }
    let edge = 180.0_f64.copysign(from[0]);
    let (before, beyond) = (edge - from[0], to[0] + edge);
    // Both are zero where a step goes along the meridian itself.
    let share = if before + beyond == 0.0 { 0.5 } else { before / (before + beyond) };
    Some((edge, from[1] + share * (to[1] - from[1])))
}

#[cfg(test)]
mod tests {
    use super::cut;

    #[test]
    fn a_track_is_cut_at_the_meridian_and_nowhere_else() {
        assert_eq!(cut(&[[-1.0, 2.0], [1.0, 3.0]]), [[[-1.0, 2.0], [1.0, 3.0]]]);
        assert_eq!(
            cut(&[[179.0, 0.0], [-177.0, 4.0], [-176.0, 5.0]]),
            [vec![[179.0, 0.0], [180.0, 1.0]], vec![[-180.0, 1.0], [-177.0, 4.0], [-176.0, 5.0]]]
        );
        assert_eq!(cut(&[[-179.0, 0.0], [179.0, 4.0]]), [[[-179.0, 0.0], [-180.0, 2.0]], [[180.0, 2.0], [179.0, 4.0]]]);
        assert_eq!(cut(&[[180.0, 0.0], [-180.0, 4.0]]).len(), 2);
    }
}
