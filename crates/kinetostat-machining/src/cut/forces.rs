//! The forces of a program's cuts.

use kinetostat::Wrench;
use kinetostat::number::{larger, short, smaller};
use kinetostat_cutting::{CutError, Edge, Engagement, Feed, Milling, Rotation, Stock};
use kinetostat_program::{Move, MoveKind, Path};
use nalgebra::{Rotation3, Vector3};

use crate::cut::finding::{CutFailure, CutFindingKind, Findings};
use crate::cut::force::{Drive, ForceOf};
use crate::cut::profile::ForceAlongPath;
use crate::cut::question::{CutQuestion, EngagementSource};
use crate::cut::station::{ACROSS, ContactArc, CutStation, SHORT_MM};
use crate::cut::walk::{Met, Walk};
use crate::watch::Watch;

/// Corners that turn by at most this do not change what the tool meets, rad.
const GENTLE: f64 = std::f64::consts::FRAC_PI_6;

/// Moves between two looks at whether to stop.
const MOVES_PER_LOOK: usize = 2000;

impl CutQuestion {
    /// The forces along a path.
    ///
    /// # Errors
    /// A value that is stated nowhere, with its line; a tool of which nothing is known; a cut that cannot be made.
    pub fn along(&self, path: &Path, watch: &dyn Watch) -> Result<ForceAlongPath, CutFailure> {
        Ok(self.along_and_left(path, watch)?.0)
    }

    /// The forces along a path, and what it leaves of the stock; `None` where the engagement comes from no stock.
    ///
    /// # Errors
    /// As [`Self::along`].
    pub fn along_and_left(
        &self,
        path: &Path,
        watch: &dyn Watch,
    ) -> Result<(ForceAlongPath, Option<Stock>), CutFailure> {
        if self.tools.is_empty()
            && let Some(first) = path.moves.iter().find(|m| m.kind == MoveKind::Feed)
        {
            return Err(CutFailure::NoTool { line: first.line });
        }
        let mut walk = Walk::new(&self.engagement, &self.tools);
        let force_of = |tool| ForceOf::new(tool, self.choice);
        let mut forces: Vec<ForceOf<'_>> = self.tools.iter().map(force_of).collect();
        let mut findings = Findings::default();
        self.lines_without_a_cut(path, &mut findings);
        let mut moves: Vec<Vec<CutStation>> = Vec::with_capacity(path.moves.len());
        // The last feed move without a rapid since, and not so short that it has no direction.
        let (mut before, mut since_mm): (Option<usize>, f64) = (None, 0.0);
        watch.stage("engagement", path.moves.len());
        for (i, motion) in path.moves.iter().enumerate() {
            if i % MOVES_PER_LOOK == 0 {
                watch.advance(i);
                if watch.cancelled() {
                    return Err(CutFailure::Cancelled);
                }
            }
            let mut stations;
            match before.filter(|_| is_short(motion, since_mm)) {
                Some(before) => {
                    self.sweep(path, motion, &mut walk)?;
                    stations = moves[before].last().map_or_else(Vec::new, standing);
                    since_mm += motion.length_mm();
                }
                None => {
                    stations = self.of_move(path, motion, &mut walk, &mut forces, &mut findings)?;
                    if let Some(before) = before.filter(|before| self.goes_on(path, *before, i)) {
                        join(moves[before].last(), &mut stations);
                    }
                    (before, since_mm) = (motion.is_known_feed().then_some(i), 0.0);
                }
            }
            moves.push(stations);
        }
        self.meets_stock(path, &moves, &mut findings)?;
        let forces = ForceAlongPath::of(moves, findings.list());
        let forces = forces.with_resolution_mm(match &self.engagement {
            EngagementSource::Stock(stock) => stock.cell_mm(),
            _ => f64::INFINITY,
        });
        Ok((forces.asked(self), walk.left()))
    }

    /// Stated lines on which the program does not cut.
    fn lines_without_a_cut(&self, path: &Path, findings: &mut Findings) {
        let EngagementSource::Lines(ranges) = &self.engagement else {
            return;
        };
        for (lines, _) in ranges {
            let mut moves = path.moves.iter().filter(|m| m.is_known_feed());
            if !moves.any(|m| lines.contains(&m.line)) {
                findings.add(CutFindingKind::LinesWithoutCut, *lines.start(), 1.0, || {
                    format!(
                        "lines {} to {} have an engagement, and no feed move stands on them",
                        lines.start(),
                        lines.end()
                    )
                });
            }
        }
    }

    /// Refuses a stock that lies beside all feed moves as seen along the tool, and tells of one that no feed move meets.
    fn meets_stock(
        &self,
        path: &Path,
        moves: &[Vec<CutStation>],
        findings: &mut Findings,
    ) -> Result<(), CutFailure> {
        let EngagementSource::Stock(stock) = &self.engagement else {
            return Ok(());
        };
        let is_cut = |station: &CutStation| station.rpm > 0.0;
        let mut feeds = path
            .moves
            .iter()
            .filter(|m| m.is_known_feed() && m.has_length());
        let Some(first) = feeds.next().filter(|_| !moves.iter().flatten().any(is_cut)) else {
            return Ok(());
        };
        let stock_mm = stock.space_mm();
        let mut path_mm: [[f64; 3]; 2] = [first.start.into(); 2];
        for place in [first]
            .into_iter()
            .chain(feeds)
            .flat_map(|m| [0.0, 1.0].map(|s| m.point(s)))
        {
            for k in 0..3 {
                path_mm[0][k] = smaller(path_mm[0][k], place[k]);
                path_mm[1][k] = larger(path_mm[1][k], place[k]);
            }
        }
        let widths = self.tools.iter().map(|tool| tool.tool.diameter_mm());
        let width_mm = widths.fold(0.0, larger);
        let is_beside = |k: usize| {
            path_mm[0][k] - width_mm > stock_mm[1][k] || path_mm[1][k] + width_mm < stock_mm[0][k]
        };
        if is_beside(0) || is_beside(1) {
            return Err(CutFailure::BesideStock { stock_mm, path_mm });
        }
        findings.add(CutFindingKind::NothingCut, first.line, 0.0, || {
            format!(
                "no feed move meets the stock, which is up to z = {} mm high; the tip goes down to z = {} mm: nothing is cut, and no force acts",
                short(stock_mm[1][2]),
                short(path_mm[0][2])
            )
        });
        Ok(())
    }

    /// A tip that is further below the stock than the tool is wide.
    fn below_stock(&self, motion: &Move, met: &Met, drive: &Drive<'_>, findings: &mut Findings) {
        let EngagementSource::Stock(stock) = &self.engagement else {
            return;
        };
        let [[_, _, bottom_mm], [_, _, top_mm]] = stock.space_mm();
        let below_mm = bottom_mm - motion.point(met.share).z;
        if below_mm > drive.tool.tool.diameter_mm() {
            findings.add(CutFindingKind::BelowTheStock, motion.line, below_mm, || {
                format!(
                    "the tip is {} mm below the bottom of a stock that is {} mm high: correct the depth of the program, its zero or the corners of the stock",
                    short(below_mm),
                    short(top_mm - bottom_mm)
                )
            });
        }
    }

    /// True if a move continues the one before in nearly the same direction and with the same tool: it then meets the same
    /// material.
    fn goes_on(&self, path: &Path, before: usize, i: usize) -> bool {
        let (before, motion) = (&path.moves[before], &path.moves[i]);
        let gentle = match (before.tangent(1.0), motion.tangent(0.0)) {
            (Some(a), Some(b)) => a.angle(&b) <= GENTLE,
            _ => false,
        };
        let tool = |m: &Move| self.tool_on(path, m.line).ok();
        before.is_known_feed() && motion.is_known_feed() && gentle && tool(before) == tool(motion)
    }

    /// Simulates a move: returns the engagement of the tool and removes the material it sweeps; unknown tools are
    /// taken as the first one.
    fn sweep(
        &self,
        path: &Path,
        motion: &Move,
        walk: &mut Walk<'_>,
    ) -> Result<Vec<Met>, CutFailure> {
        let tool = self.tool_on(path, motion.line).unwrap_or(0);
        let met = walk.go(motion, tool);
        met.map_err(|error| cut_failure(motion, error))
    }

    fn of_move(
        &self,
        path: &Path,
        motion: &Move,
        walk: &mut Walk<'_>,
        forces: &mut [ForceOf<'_>],
        findings: &mut Findings,
    ) -> Result<Vec<CutStation>, CutFailure> {
        let cut = |error| cut_failure(motion, error);
        let tool = self.tool_on(path, motion.line);
        if motion.kind == MoveKind::Rapid {
            // Without a known tool nothing is known to be swept.
            if tool.is_ok() {
                let met = self.sweep(path, motion, walk)?;
                rapid_through(&met, motion.line, findings);
            }
            return Ok(Vec::new());
        }
        let met = self.sweep(path, motion, walk)?;
        // Missing tool data is an error only on cutting moves.
        if met.iter().all(|met| met.engagement.is_air()) {
            return Ok(met.iter().map(|met| CutStation::air(met.share)).collect());
        }
        let tool = tool?;
        let drive = self.drive(path, motion, tool)?;
        let mut stations = Vec::with_capacity(met.len());
        for met in &met {
            if met.engagement.is_air() {
                stations.push(CutStation::air(met.share));
                continue;
            }
            let feed = feed_along(drive.per_tooth_mm, &met.direction).map_err(cut)?;
            let of = forces[tool].of(&met.engagement, feed, drive.rotation);
            let (force, torque) = of.map_err(cut)?;
            let wrench = Wrench::new(force.force_n, force.moment_n_mm * 1e-3);
            let of_tool = drive.tool;
            let cut = Milling::new(&of_tool.tool, &*of_tool.law, &met.engagement, feed);
            let station = CutStation {
                share: met.share,
                wrench: in_axes_of_load(wrench, &met.direction),
                torque_n_m: 1e-3 * torque,
                depth_mm: met.engagement.depth_mm(),
                arc: arc_of(&met.engagement),
                contact: (drive.rotation == Rotation::Clockwise)
                    .then(|| ContactArc::of(&met.engagement))
                    .flatten(),
                chip_mm: cut.turning(drive.rotation).largest_chip_mm(),
                feed_per_tooth_mm: drive.per_tooth_mm,
                rpm: drive.rpm,
            };
            self.below_stock(motion, met, &drive, findings);
            self.look_at(
                &station,
                &met.engagement,
                &drive,
                feed,
                motion.line,
                findings,
            );
            stations.push(station);
        }
        Ok(stations)
    }
}

fn cut_failure(motion: &Move, error: CutError) -> CutFailure {
    CutFailure::Cut {
        line: motion.line,
        error: Box::new(error),
    }
}

/// Feed moves that are so short, or so close to the last cut that was looked at, that their own direction says nothing.
fn is_short(motion: &Move, since_mm: f64) -> bool {
    let length = motion.length_mm();
    motion.is_known_feed() && (length < 0.1 * SHORT_MM || since_mm + length < 0.5 * SHORT_MM)
}

/// Stations of a dwell: the last force acts on.
fn standing(last: &CutStation) -> Vec<CutStation> {
    [0.0, 1.0]
        .map(|share| CutStation { share, ..*last })
        .to_vec()
}

/// A rapid that meets material.
fn rapid_through(met: &[Met], line: usize, findings: &mut Findings) {
    for met in met.iter().filter(|met| !met.engagement.is_air()) {
        let depth = met.engagement.depth_mm();
        findings.add(CutFindingKind::RapidThroughStock, line, depth, || {
            match depth > 0.0 {
                true => format!("a rapid goes through material, {depth:.2} mm deep"),
                false => "a rapid goes down onto material".to_owned(),
            }
        });
    }
}

/// Straight up and down there is no feed across the axis: forces are in axes of the part then, whatever little direction the
/// move has.
fn in_axes_of_load(wrench: Wrench, direction: &Vector3<f64>) -> Wrench {
    let across = direction.xy().norm();
    match across <= ACROSS && across > NO_DIRECTION {
        true => {
            let angle = direction.y.atan2(direction.x);
            wrench.rotated(&Rotation3::from_axis_angle(&Vector3::z_axis(), angle))
        }
        false => wrench,
    }
}

/// Minimum size of the feed across the tool axis; below it the stock takes x of the part for its direction.
const NO_DIRECTION: f64 = 1e-9;

/// Begins a move with what acted at the end of the one before: short moves have one station, at their end, and the load
/// does not jump from each to the next.
fn join(last: Option<&CutStation>, stations: &mut Vec<CutStation>) {
    if let (Some(last), Some(first)) = (last, stations.first())
        && first.share > 0.0
    {
        stations.insert(
            0,
            CutStation {
                share: 0.0,
                ..*last
            },
        );
    }
}

/// Feed per tooth across the axis (z of the part) and down along it.
fn feed_along(per_tooth_mm: f64, direction: &Vector3<f64>) -> kinetostat_cutting::Result<Feed> {
    let across = direction.xy().norm();
    // Edges along the axis do not rub because a plunge is a hair off it.
    let level = match across > ACROSS {
        true => per_tooth_mm * across,
        false => 0.0,
    };
    let down = -per_tooth_mm * direction.z;
    // Programs state four decimals: a slope of less than that is none.
    match direction.z.abs() < 1e-6 {
        true => Feed::level(per_tooth_mm),
        false => Feed::ramp(level, down),
    }
}

/// Sum of the arcs at the lowest height in contact.
fn arc_of(engagement: &Engagement) -> f64 {
    let side = engagement.contacts.iter().filter(|c| c.edge == Edge::Side);
    let lowest = side
        .clone()
        .map(|c| c.from_mm)
        .reduce(|a, b| if b < a { b } else { a });
    lowest.map_or(0.0, |lowest| {
        let there = side.filter(|c| c.from_mm <= lowest + 1e-9);
        there.map(|c| c.exit - c.entry).sum()
    })
}
