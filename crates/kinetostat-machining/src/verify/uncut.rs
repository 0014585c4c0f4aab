//! Parts of the original that a program leaves out.

use kinetostat_program::{Corrected, NominalPath, Path};

use crate::verify::matched::Uncut;

/// Smallest length at an end of a pass, mm, that is a part left out: the tool is off by as much there.
pub(crate) const LEAST_MM: f64 = 0.05;

/// Smallest length inside a pass, mm, where the original goes on cutting and the program makes a rapid, that is more than the rounding
/// of ends; or twice the distance of the program from its guide.
const LEAST_INSIDE_MM: f64 = 0.002;

/// The parts of the guide that no pass of the program covers; `covered` are the lengths along the guide at which each begins and ends,
/// in their order, and `near_mm` is how near the program usually is to the guide.
pub(crate) fn uncut(
    original: &Path,
    guide: (&NominalPath<'_>, &Corrected),
    (covered, near_mm): (&[[f64; 2]], f64),
) -> Vec<Uncut> {
    let (nominal, _) = guide;
    let inside_mm = LEAST_INSIDE_MM.max(2.0 * near_mm).min(LEAST_MM);
    let is_inside = |from: f64, to: f64| {
        nominal.passes().iter().any(|pass| {
            let [begins, ends] = pass.along_mm;
            begins + LEAST_MM < from && to < ends - LEAST_MM
        })
    };
    let least_mm = |from: f64, to: f64| match is_inside(from, to) {
        true => inside_mm,
        false => LEAST_MM,
    };
    let ends = covered.iter().map(|stretch| stretch[1]);
    let from = std::iter::once(0.0).chain(ends);
    let begins = covered.iter().map(|stretch| stretch[0]);
    let to = begins.chain(std::iter::once(nominal.length_mm()));
    from.zip(to)
        .filter(|(from, to)| to - from > least_mm(*from, *to))
        .map(|(from, to)| {
            // Just inside: at a corner two lines meet.
            let inside = 0.5 * LEAST_MM.min(to - from);
            Uncut {
                lines: [from + inside, to - inside].map(|at| line(original, guide, at)),
                length_mm: to - from,
            }
        })
        .collect()
}

/// Line of the original at a length along the guide.
fn line(original: &Path, (nominal, written): (&NominalPath<'_>, &Corrected), along: f64) -> usize {
    let (index, _) = nominal.at_length(along);
    let piece = &written.pieces[nominal.pieces()[index].move_index];
    original.moves[piece.move_index].line
}
