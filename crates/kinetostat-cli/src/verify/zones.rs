//! Approximation at the ends of motions of robots.

use kinetostat_formats::Zone;

use crate::job::robot::read_program::RobotRead;
use crate::ui::numbers::short;
use crate::verify::other_word::{FaultKind, OtherWord};

/// The radius of RAPID's z0, with which steps are passed, mm.
const PASSED_MM: f64 = 0.3;

/// Differences between the zones of both programs.
pub(crate) fn other_zones(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Vec<OtherWord> {
    let stops = fewer_stops(original, verified);
    let radii = radii(original, verified, stops.is_some());
    radii.into_iter().chain(stops).collect()
}

/// Width of a zone, in its unit; none if it is unknown.
fn width(zone: Zone) -> Option<f64> {
    match zone {
        Zone::Exact => Some(0.0),
        Zone::Radius(width) | Zone::Percent(width) => Some(width),
        Zone::Unstated => None,
    }
}

/// Ends at which the tool stopped, or that it passed more nearly.
fn fewer_stops(original: &RobotRead<'_>, verified: &RobotRead<'_>) -> Option<OtherWord> {
    let widths = |read: &RobotRead<'_>| -> Vec<f64> {
        let motions = read.program.motions.iter();
        let mut all: Vec<f64> = motions.filter_map(|m| width(m.zone)).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let [own, of_original] = [verified, original].map(widths);
    let count = |all: &[f64], most: f64| all.iter().filter(|width| **width <= most).count();
    let fewer = |most: &&f64| count(&own, **most) < count(&of_original, **most);
    let most = *of_original.iter().find(fewer)?;
    let [own, of_original] = [&own, &of_original].map(|all| count(all, most));
    let ends = match most > 0.0 {
        true => format!("pass their ends by no more than zone {}", short(most)),
        false => "stop at their ends".to_owned(),
    };
    let text = format!(
        "{of_original} motions of the original {ends}, and {own} of this program: corners are left by what the control allows, and no figure has that in it"
    );
    let fault = Some(FaultKind::PathMode);
    Some(OtherWord::new("exact stop", fault, [None, None], text))
}

/// Ends that are passed at a larger distance.
fn radii(
    original: &RobotRead<'_>,
    verified: &RobotRead<'_>,
    stops_less: bool,
) -> Option<OtherWord> {
    let largest = |read: &RobotRead<'_>| {
        let motions = read.program.motions.iter();
        let radii = motions.filter_map(|m| match m.zone {
            Zone::Radius(mm) => Some((mm, m.line)),
            Zone::Exact | Zone::Percent(_) | Zone::Unstated => None,
        });
        radii.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (mm, line) = largest(verified)?;
    let of_original = largest(original).map_or(0.0, |(mm, _)| mm);
    // Pieces of a motion of KRL that stops pass their ends within the distance in force.
    let may_be_pieces =
        verified.program.language.pieces_pass_their_ends() && of_original == 0.0 && !stops_less;
    let fault = (!may_be_pieces).then_some(FaultKind::PathMode);
    (mm > PASSED_MM && mm > of_original).then(|| {
        let text = format!(
            "the end of the motion at line {line} is passed at up to {} mm, those of the original at {}: no figure has that in it",
            short(mm),
            short(of_original)
        );
        OtherWord::new("zone", fault, [Some(line), None], text)
    })
}
