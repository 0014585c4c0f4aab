//! Removal of what a tool sweeps.

use crate::stock::grid::Stock;
use crate::stock::profile::Profile;
use crate::stock::sweep::{Seen, Sweep};

/// Cuts that lower a point by less than this share of a cell leave the wall above where it is.
const SKIN: f64 = 0.25;

/// Start of a move, relative to the last one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    /// The tool has cut here already.
    Continued,
    New,
}

/// Columns between two places of a row, as indices.
fn indices(stock: &Stock, [low, high]: [f64; 2], axis: usize) -> [usize; 2] {
    let index = |value: f64| (value - stock.origin[axis]) * stock.per_mm;
    let most = stock.points[axis] as f64;
    // Casts hold at 0 and below at 0.
    [
        index(low).ceil().min(most) as usize,
        (index(high).floor() + 1.0).min(most) as usize,
    ]
}

impl Stock {
    /// Calls `at(index, seen)` at the points within `reach` of the move, but not within `done` of its start.
    #[inline]
    fn along(&self, sweep: &Sweep, reach: f64, done: f64, mut at: impl FnMut(usize, Seen)) {
        let [first_row, last_row] = indices(self, sweep.rows(reach), 1);
        for j in first_row..last_row {
            let y = self.origin[1] + j as f64 * self.cell;
            let Some(span) = sweep.span(y, reach) else {
                continue;
            };
            let [first, last] = indices(self, span, 0);
            let [hole, after] = match sweep.start_span(y, done) {
                Some(inner) => indices(self, inner, 0),
                None => [last, last],
            };
            let parts = match hole < after {
                true => [[first, hole.min(last)], [after.max(first), last]],
                false => [[first, last], [last, last]],
            };
            let row = j * self.points[0];
            for [from, to] in parts {
                for i in from..to {
                    let x = self.origin[0] + i as f64 * self.cell;
                    at(row + i, sweep.see(x, y));
                }
            }
        }
    }

    /// True if a tool meets material on a move.
    pub(crate) fn is_touched(&self, profile: &Profile, sweep: &Sweep) -> bool {
        let reach = profile.reach(self.height - sweep.lowest());
        let tolerance = self.tolerance();
        let mut touched = false;
        // Slivers are no contact.
        self.along(
            sweep,
            reach - self.sliver(profile.outer).depth,
            0.0,
            |index, seen| {
                let top = f64::from(self.columns[index].top);
                touched |= top > 0.0 && top > sweep.height(profile, &seen, reach) + tolerance;
            },
        );
        touched
    }

    /// Removes what a tool sweeps on a move.
    pub(crate) fn cut(&mut self, profile: &Profile, from: [f64; 3], to: [f64; 3]) {
        let start = self.settle(profile, from);
        self.carve(profile, &Sweep::new(from, to, self.bottom), start);
        self.front = Some((*profile, to));
    }

    /// A move begins. If it is not of the tool that was here last, or begins elsewhere, the wall before that tool stays: the
    /// points there get their distance from it. While a tool goes on they do not: the wall moves with it.
    pub(crate) fn settle(&mut self, profile: &Profile, from: [f64; 3]) -> Start {
        match self.front {
            Some((last, place)) if last == *profile && place == from => Start::Continued,
            Some((last, place)) => {
                self.front = None;
                self.carve(
                    &last,
                    &Sweep::new(place, place, self.bottom),
                    Start::Continued,
                );
                Start::New
            }
            None => Start::New,
        }
    }

    /// Points inside are lowered and get their depth behind the wall; points outside get their distance from it.
    fn carve(&mut self, profile: &Profile, sweep: &Sweep, start: Start) {
        if sweep.lowest() >= self.height {
            return;
        }
        let known = self.known();
        let reach = profile.reach(self.height - sweep.lowest());
        let wall = profile.outer;
        let done = match start == Start::Continued && sweep.never_down() {
            true => profile.end - known,
            false => 0.0,
        };
        let seen_from = if reach < wall { reach } else { wall + known };
        // The floor that the tool has left is no wall above it, whatever the rounding of its height.
        let tolerance = self.tolerance();
        let skin = (SKIN * self.cell) as f32;
        let (wall_square, reach_square) = (wall * wall, reach * reach);
        let deep_square = (wall - known).max(0.0) * (wall - known);
        // On a continued move, points behind the start lack only their distances outside.
        let all_done = start == Start::Continued && sweep.never_down();
        // Out of the struct while it is read for the geometry; no column is copied.
        let mut columns = std::mem::take(&mut self.columns);
        let nx = self.points[0];
        self.along(sweep, seen_from, done, |index, seen| {
            if seen.square > wall_square {
                let column = &mut columns[index];
                if column.top <= 0.0 || sweep.is_ahead(&seen) {
                    return;
                }
                let distance = (seen.square.sqrt() - wall) as f32;
                if distance < column.drop
                    && f64::from(column.top)
                        > sweep.height(profile, &seen, wall + known) + tolerance
                {
                    column.drop = distance;
                    column.drop_normal = sweep.outward(&seen);
                }
                return;
            }
            if seen.square > reach_square || all_done && sweep.is_behind(&seen) {
                return;
            }
            let depth = match seen.square < deep_square {
                true => known as f32,
                false => (wall - seen.square.sqrt()).min(known) as f32,
            };
            let height = sweep.height(profile, &seen, reach).max(0.0) as f32;
            let column = &mut columns[index];
            let lowered = column.top - height;
            // Outside the stock, the outline remains below a tool that passes above the bottom.
            let beside = column.top <= 0.0 && height > skin;
            if !beside && (lowered > skin || depth > column.rise) {
                column.rise = depth;
                if f64::from(depth) < known {
                    column.rise_normal = sweep.outward(&seen);
                }
            }
            if lowered <= 0.0 {
                return;
            }
            column.top = height;
            if f64::from(column.drop) < known && !falls_off(&columns, index, nx, height - skin) {
                columns[index].drop = known as f32;
            }
        });
        self.columns = columns;
    }
}

/// True if a neighbour is lower than this: the wall down there still exists.
fn falls_off(columns: &[super::grid::Column], index: usize, nx: usize, level: f32) -> bool {
    let rows = [index.wrapping_sub(nx), index, index + nx];
    rows.iter().any(|row| {
        [row.wrapping_sub(1), *row, row + 1]
            .iter()
            .any(|i| columns.get(*i).is_some_and(|column| column.top < level))
    })
}
