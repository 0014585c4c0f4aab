//! Stretches of a program that are cut without a rapid between them.

use kinetostat_program::{Move, MoveKind, Path};

use crate::cut::station::SHORT_MM;
use crate::profile::limited::{Begins, Place, SinceRapid};

/// Feed moves that follow each other without a rapid, by their indices; `joined` says whether a run goes on from one move to the
/// next. Moves so short that they have no direction are part of the run that they follow.
pub(crate) fn runs(path: &Path, joined: impl Fn(&Move, &Move) -> bool) -> Vec<Vec<usize>> {
    let mut runs: Vec<Vec<usize>> = Vec::new();
    let mut open = false;
    // The last move of the open run that has a direction.
    let mut before: Option<&Move> = None;
    for (i, motion) in path.moves.iter().enumerate() {
        if !motion.is_known_feed() {
            (open, before) = (false, None);
            continue;
        }
        let short = motion.length_mm() < SHORT_MM;
        let goes_on = short || before.is_none_or(|before| joined(before, motion));
        match runs.last_mut().filter(|_| open && goes_on) {
            Some(run) => run.push(i),
            None => runs.push(vec![i]),
        }
        open = true;
        if !short {
            before = Some(motion);
        }
    }
    runs
}

/// Initial condition of the run that begins with a move, for all moves: after a rapid nothing acts.
pub(crate) fn begins(path: &Path) -> Vec<Begins> {
    let mut all = vec![Begins::Anyhow; path.moves.len()];
    let mut from = 0;
    while from < path.moves.len() {
        let feed = path.moves[from..].iter().take_while(|m| m.is_known_feed());
        let lengths: Vec<f64> = feed.map(Move::length_mm).collect();
        let after_rapid = from > 0 && path.moves[from - 1].kind == MoveKind::Rapid;
        if after_rapid {
            let in_all_mm = lengths.iter().sum();
            let mut before_mm = 0.0;
            for (own, length) in all[from..].iter_mut().zip(&lengths) {
                *own = Begins::WithNothing(SinceRapid {
                    before_mm,
                    in_all_mm,
                });
                before_mm += length;
            }
        }
        from += lengths.len() + 1;
    }
    all
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
