//! Places at which a program is evaluated as it is given.

use kinetostat_program::{Knowledge, MoveKind, Path};

use crate::load::along_path::LoadAlongPath;
use crate::placement::Placement;
use crate::run::sites::of_load::{jumps, places_of_load};
use crate::run::sites::programmed::Programmed;
use crate::run::sites::site::{Site, kind, spacing_mm, starts, stays};
use crate::task::Task;

/// Places at which a program is evaluated as it is given: ends and middles of all blocks, and their starts where the load jumps; of
/// blocks longer than a spacing those of their pieces; and inside the others where the load departs from the line between their ends.
struct OfPath<'a> {
    path: &'a Path,
    load: &'a LoadAlongPath<'a>,
    placement: &'a Placement,
    starts: Vec<f64>,
    programmed: Programmed,
}

impl<'a> OfPath<'a> {
    fn new(task: &'a Task<'_>, load: &'a LoadAlongPath<'a>) -> Self {
        let path = task.path();
        Self {
            path,
            load,
            placement: &task.placement,
            starts: starts(path),
            programmed: Programmed::new(path, spacing_mm(task)),
        }
    }

    /// Shares of a move in order, and which of them are ends.
    fn shares(&self, i: usize) -> Vec<(f64, bool)> {
        let motion = &self.path.moves[i];
        match (motion.known, motion.kind) {
            (Knowledge::Nothing, _) => Vec::new(),
            (Knowledge::End, _) | (_, MoveKind::Rapid) => vec![(1.0, true)],
            (Knowledge::Whole, MoveKind::Feed) if stays(motion) => Vec::new(),
            (Knowledge::Whole, MoveKind::Feed) => {
                let pieces = self.programmed.pieces(motion);
                let jumps = jumps(self.path, self.load, self.placement, i);
                let start = jumps.then_some((0.0, false)).into_iter();
                let mut shares: Vec<(f64, bool)> = start
                    .chain(self.programmed.shares(motion, pieces))
                    .collect();
                if pieces == 1 {
                    let inside = places_of_load(self.load, self.placement, i);
                    shares.extend(inside.into_iter().map(|share| (share, false)));
                    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
                    shares.dedup_by(|later, first| later.0 == first.0);
                }
                shares
            }
        }
    }

    /// The place at a share of a move, with what acts there.
    fn site(&self, i: usize, share: f64, end: bool) -> Site {
        let motion = &self.path.moves[i];
        let desired = motion.point(share);
        Site {
            line: motion.line,
            move_index: i,
            kind: kind(motion),
            share,
            path_mm: self.starts[i] + share * motion.known_length_mm(),
            start_mm: self.starts[i],
            programmed: true,
            desired,
            commanded: desired,
            orientation: motion.orientation(share),
            commanded_orientation: motion.orientation(share),
            wrench: self.load.wrench(self.placement, i, share),
            end,
            ..Site::default()
        }
    }
}

/// The places of [`OfPath`], one after the other.
pub(crate) fn sites_of_path<'a>(
    task: &'a Task<'_>,
    load: &'a LoadAlongPath<'a>,
) -> impl Iterator<Item = Site> + 'a {
    let of_path = OfPath::new(task, load);
    task.path().own_moves().flat_map(move |i| {
        let shares = of_path.shares(i).into_iter();
        let sites = shares.map(|(share, end)| of_path.site(i, share, end));
        sites.collect::<Vec<_>>()
    })
}

/// Places at shares of moves, as the program is given; none on moves that lead nowhere, and the end of a rapid or of a move from
/// a place that the program does not state.
pub(crate) fn places_on_moves(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    chosen: &[(usize, f64)],
) -> Vec<Site> {
    let path = task.path();
    let of_path = OfPath::new(task, load);
    let site = |(index, share): &(usize, f64)| {
        let motion = &path.moves[*index];
        let share = match (motion.known, motion.kind) {
            (Knowledge::Nothing, _) => return None,
            (Knowledge::Whole, MoveKind::Feed) if stays(motion) => return None,
            (Knowledge::Whole, MoveKind::Feed) => *share,
            _ => 1.0,
        };
        Some(of_path.site(*index, share, share == 1.0))
    };
    chosen.iter().filter_map(site).collect()
}
