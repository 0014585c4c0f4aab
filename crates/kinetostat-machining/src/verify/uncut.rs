//! What of the original a program leaves out.

use kinetostat_program::{Corrected, NominalPath, Path};

use crate::verify::matched::Uncut;

/// Less than this is left out by where an end of a pass is rounded to, mm.
const LEAST_MM: f64 = 0.05;

/// The parts of the guide that no pass of the program covers; `covered` are the lengths along the guide at which each begins and ends,
/// in their order.
pub(crate) fn uncut(
    original: &Path,
    guide: (&NominalPath<'_>, &Corrected),
    covered: &[[f64; 2]],
) -> Vec<Uncut> {
    let (nominal, _) = guide;
    let ends = covered.iter().map(|stretch| stretch[1]);
    let from = std::iter::once(0.0).chain(ends);
    let begins = covered.iter().map(|stretch| stretch[0]);
    let to = begins.chain(std::iter::once(nominal.length_mm()));
    from.zip(to)
        .filter(|(from, to)| to - from > LEAST_MM)
        .map(|(from, to)| Uncut {
            // Just inside: at a corner two lines meet.
            lines: [from + 0.5 * LEAST_MM, to - 0.5 * LEAST_MM].map(|at| line(original, guide, at)),
            length_mm: to - from,
        })
        .collect()
}

/// Line of the original at a length along the guide.
fn line(original: &Path, (nominal, written): (&NominalPath<'_>, &Corrected), along: f64) -> usize {
    let (index, _) = nominal.at_length(along);
    let piece = &written.pieces[nominal.pieces()[index].move_index];
    original.moves[piece.move_index].line
}
