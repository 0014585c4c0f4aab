//! Check that the box around the part is that of the part that the program cuts.

use kinetostat::number::larger;
use kinetostat_analysis::placing::PartBox;
use kinetostat_machining::number::largest_length;
use kinetostat_machining::{Warning, WarningCode};
use kinetostat_program::Path;
use nalgebra::Vector3;

/// A tool may cut beside its part by its own radius: cuts farther from the box than this, mm, and than this share of its diagonal, are
/// of another part, or in other axes.
const BESIDE: (f64, f64) = (50.0, 0.1);

/// Places of a move that are looked at.
const SHARES: [f64; 3] = [0.0, 0.5, 1.0];

/// Warning if the program cuts far outside the box.
pub(crate) fn beside_the_part(part: &PartBox, path: &Path) -> Option<Warning> {
    let outside = |point: &Vector3<f64>| {
        let beyond = |k: usize| larger(part.from_mm[k] - point[k], point[k] - part.to_mm[k]);
        let apart = [0, 1, 2].map(|k| larger(beyond(k), 0.0));
        Vector3::from(apart).norm()
    };
    let cuts = path.moves.iter().filter(|motion| motion.is_known_feed());
    let places = cuts.flat_map(|motion| SHARES.map(|share| (motion.line, motion.point(share))));
    let distances = places.map(|(line, point)| (line, outside(&point)));
    let (line, farthest_mm) = distances.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let diagonal_mm = (Vector3::from(part.to_mm) - Vector3::from(part.from_mm)).norm();
    let (least_mm, share) = BESIDE;
    (farthest_mm > larger(least_mm, share * diagonal_mm)).then(|| {
        let text = format!(
            "the program cuts up to {} outside part_box_mm: the box is in mm along the axes of the program, around the part as it is clamped; obstacles were kept clear of this box only",
            largest_length(farthest_mm)
        );
        Warning::at_line(WarningCode::Program, line, text)
    })
}
