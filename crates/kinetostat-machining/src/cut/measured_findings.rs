//! Plausibility of measured forces.

use kinetostat::number::larger;
use kinetostat_program::{Move, MoveKind, Path};

use crate::cut::clock::cuts;
use crate::cut::finding::{CutFinding, CutFindingKind, Findings};
use crate::cut::measured_stations::Laid;

/// Share of the largest force that is no force yet.
const NOISE: f64 = 0.05;

/// Share of a move that need not be covered: that of a rounded number.
const ROUNDED: f64 = 1e-6;

/// Warnings about measured forces. `largest_n` is the largest force of a cut, N; `margin` is the uncertainty, s, of the place of
/// a rapid together with the window of the mean; `air` are stretches in air, s of the log.
pub(crate) fn findings(
    laid: &Laid<'_>,
    path: &Path,
    largest_n: f64,
    margin: f64,
    air: &[[f64; 2]],
) -> Vec<CutFinding> {
    let mut findings = Findings::default();
    for i in &laid.clock.unknown {
        let line = path.moves[*i].line;
        findings.add(CutFindingKind::TimeUnknown, line, 0.0, || {
            "where this move begins is not known, and so not how long it takes: it is taken to take no time"
                .to_owned()
        });
    }
    for (line, kind) in &laid.clock.pauses {
        findings.add(CutFindingKind::TimeUnknown, *line, 1.0, || {
            format!(
                "how long {} takes is stated nowhere: it is taken to take no time, and what the log has behind it would be too early; cut program and log in two there",
                kind.description()
            )
        });
    }
    let in_air = air.iter().map(|stretch| largest_in(laid, *stretch));
    let noise = 1.5 * in_air.fold(0.0, larger);
    let least = larger(NOISE * largest_n, noise);
    for (i, motion) in path.moves.iter().enumerate() {
        if cuts(motion) {
            not_measured(laid, motion, i, &mut findings);
        }
        let Some([from, to]) = laid.covered(i) else {
            continue;
        };
        if motion.kind == MoveKind::Rapid && to - from > 2.0 * margin {
            let size = largest_in(laid, [from + margin, to - margin]);
            if size > least {
                findings.add(CutFindingKind::ForceInRapid, motion.line, size, || {
                    format!(
                        "{size:.1} N were measured in a rapid, {:.0} % of the largest force: the log or its shift is not that of this program, the drift is not removed, or the tool touches the part",
                        100.0 * size / largest_n
                    )
                });
            }
        }
    }
    findings.list()
}

fn not_measured(laid: &Laid<'_>, motion: &Move, i: usize, findings: &mut Findings) {
    let [from, to] = laid.span(i);
    let covered = laid.covered(i).map_or(0.0, |[from, to]| to - from);
    let missing = 1.0 - covered / (to - from);
    if missing > ROUNDED {
        let length = motion.length_mm();
        findings.add(
            CutFindingKind::NotMeasured,
            motion.line,
            missing * length,
            || {
                format!(
                    "the log covers {:.2} mm of {length:.2} mm of this move: no force acts on the rest",
                    (1.0 - missing) * length
                )
            },
        );
    }
}

/// The largest force between two places of the log, N.
fn largest_in(laid: &Laid<'_>, [from, to]: [f64; 2]) -> f64 {
    let rows = laid.log.rows_between(from, to).iter().copied();
    let places = rows.chain([from, to]);
    places.map(|at| laid.size(at)).fold(0.0, larger)
}
