//! Stretches of a program that are cut without a rapid between them.

use kinetostat_program::{Move, MoveKind, Path};

use crate::cut::station::SHORT_MM;
use crate::profile::limited::{Begins, Place};

/// Feed moves that follow each other without a rapid, by their indices; `joined` says whether a run goes on from one move to the
/// next.
pub(crate) fn runs(path: &Path, joined: impl Fn(&Move, &Move) -> bool) -> Vec<Vec<usize>> {
    let mut runs: Vec<Vec<usize>> = Vec::new();
    let mut open = false;
    for (i, motion) in path.moves.iter().enumerate() {
        if !motion.is_known_feed() {
            open = false;
            continue;
        }
        if motion.length_mm() < SHORT_MM {
            continue;
        }
        let last = runs.last_mut().filter(|_| open);
        match last {
            Some(run) if joined(&path.moves[run[run.len() - 1]], motion) => run.push(i),
            _ => runs.push(vec![i]),
        }
        open = true;
    }
    runs
}

/// After a rapid nothing acts.
pub(crate) fn begins(path: &Path, first: usize) -> Begins {
    let before = first.checked_sub(1).map(|before| &path.moves[before]);
    match before {
        Some(before) if before.kind == MoveKind::Rapid => Begins::WithNothing,
        _ => Begins::Anyhow,
    }
}

/// The places of a run, with the way along it.
pub(crate) fn of_run<const N: usize>(
    path: &Path,
    run: &[usize],
    of_move: impl Fn(usize) -> Vec<(f64, [f64; N], bool)>,
) -> Vec<Place<N>> {
    let mut places = Vec::new();
    let mut start = 0.0;
    for &move_index in run {
        let length = path.moves[move_index].length_mm();
        let own = of_move(move_index).into_iter();
        places.extend(own.map(|(share, value, counts)| Place {
            move_index,
            share,
            at_mm: start + share * length,
            value,
            counts,
        }));
        start += length;
    }
    places
}
