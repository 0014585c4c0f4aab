//! The forces of a program's cuts.

use std::f64::consts::TAU;

use kinetostat::Wrench;
use kinetostat::number::larger;
use kinetostat_cutting::{Contact, Edge, Engagement, Feed, Rotation, SpindleCurve};
use kinetostat_program::{Knowledge, Move, MoveKind, Path, SpindleRotation};
use nalgebra::{Rotation3, Vector3};

use crate::cut::choice::ForceChoice;
use crate::cut::cutting_tool::CuttingTool;
use crate::cut::engagement_source::EngagementSource;
use crate::cut::failure::CutFailure;
use crate::cut::finding::{CutFindingKind, Findings};
use crate::cut::force::ForceOf;
use crate::cut::profile::ForceAlongPath;
use crate::cut::station::{ACROSS, CutStation};
use crate::cut::thickest::thickest_chip_mm;
use crate::cut::walk::Walk;
use crate::watch::Watch;

/// The question: which tools cut what, where.
#[derive(Clone, Debug)]
pub struct CutQuestion {
    /// Tools; one without a number is that of all blocks whose tool has no entry.
    pub tools: Vec<CuttingTool>,
    /// Where they are in the material.
    pub engagement: EngagementSource,
    /// Which force of a revolution counts.
    pub choice: ForceChoice,
    /// Speed of the spindle instead of the program's, rpm.
    pub rpm: Option<f64>,
    /// Sense of the spindle instead of the program's.
    pub rotation: Option<Rotation>,
    /// What the spindle can.
    pub spindle: Option<SpindleCurve>,
}

/// How the tool turns and goes on a move.
struct Drive {
    tool: usize,
    rotation: Rotation,
    rpm: f64,
    per_tooth_mm: f64,
}

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
        if self.tools.is_empty()
            && let Some(first) = path.moves.iter().find(|m| m.kind == MoveKind::Feed)
        {
            return Err(CutFailure::NoTool { line: first.line });
        }
        let mut walk = Walk::new(&self.engagement, &self.tools);
        let mut forces: Vec<ForceOf<'_>> = self
            .tools
            .iter()
            .map(|tool| ForceOf::new(tool, self.choice))
            .collect();
        let mut findings = Findings::default();
        let mut moves = Vec::with_capacity(path.moves.len());
        watch.stage("engagement", path.moves.len());
        for (i, motion) in path.moves.iter().enumerate() {
            if i % MOVES_PER_LOOK == 0 {
                watch.advance(i);
                if watch.cancelled() {
                    return Err(CutFailure::Cancelled);
                }
            }
            let mut stations = self.of_move(path, motion, &mut walk, &mut forces, &mut findings)?;
            if self.goes_on(path, i) {
                join(moves.last(), &mut stations);
            }
            moves.push(stations);
        }
        Ok(ForceAlongPath::of(moves.into_iter(), findings.list()))
    }

    /// Whether a move goes on where the one before ends, in nearly the same direction and with the same tool: what the tool
    /// meets there is what it met before.
    fn goes_on(&self, path: &Path, i: usize) -> bool {
        let Some(before) = i.checked_sub(1).map(|before| &path.moves[before]) else {
            return false;
        };
        let cuts = |m: &Move| m.kind == MoveKind::Feed && m.known == Knowledge::Whole;
        let motion = &path.moves[i];
        let gentle = match (before.tangent(1.0), motion.tangent(0.0)) {
            (Some(a), Some(b)) => a.angle(&b) <= GENTLE,
            _ => false,
        };
        let tool = |m: &Move| self.tool_on(path, m.line).ok();
        cuts(before) && cuts(motion) && gentle && tool(before) == tool(motion)
    }

    fn of_move(
        &self,
        path: &Path,
        motion: &Move,
        walk: &mut Walk<'_>,
        forces: &mut [ForceOf<'_>],
        findings: &mut Findings,
    ) -> Result<Vec<CutStation>, CutFailure> {
        let mut stations = Vec::new();
        let cut = |error| CutFailure::Cut {
            line: motion.line,
            error: Box::new(error),
        };
        let tool = self.tool_on(path, motion.line);
        if motion.kind == MoveKind::Rapid {
            // Nothing is known to be swept.
            let Ok(tool) = tool else {
                return Ok(stations);
            };
            let through = walk.go(motion, tool, |_, _, engagement| {
                if !engagement.is_air() {
                    let depth = engagement.depth_mm();
                    findings.add(
                        CutFindingKind::RapidThroughStock,
                        motion.line,
                        depth,
                        || format!("a rapid goes through material, {depth:.2} mm deep"),
                    );
                }
            });
            through.map_err(cut)?;
            return Ok(stations);
        }
        // What is missing matters where something is cut.
        let mut drive: Option<Result<Drive, CutFailure>> = None;
        let mut wrong = None;
        let whole = walk.go(
            motion,
            tool.clone().unwrap_or(0),
            |share, direction, engagement| {
                if wrong.is_some() {
                    return;
                }
                if engagement.is_air() {
                    stations.push(CutStation::air(share));
                    return;
                }
                let drive = drive.get_or_insert_with(|| self.drive(path, motion, &tool));
                match drive {
                    Err(failure) => wrong = Some(failure.clone()),
                    Ok(drive) => {
                        let feed = feed_along(drive.per_tooth_mm, &direction);
                        let force = feed.and_then(|feed| {
                            let of = forces[drive.tool].of(engagement, feed, drive.rotation)?;
                            Ok((feed, of))
                        });
                        match force {
                            Err(error) => wrong = Some(cut(error)),
                            Ok((feed, (force, torque))) => {
                                let wrench = Wrench::new(force.force_n, force.moment_n_mm * 1e-3);
                                let wrench = in_axes_of_load(wrench, &direction);
                                let station = CutStation {
                                    share,
                                    wrench,
                                    torque_n_m: 1e-3 * torque,
                                    depth_mm: engagement.depth_mm(),
                                    arc: arc_of(engagement),
                                };
                                self.look_at(
                                    &station,
                                    engagement,
                                    drive,
                                    feed,
                                    motion.line,
                                    findings,
                                );
                                stations.push(station);
                            }
                        }
                    }
                }
            },
        );
        whole.map_err(cut)?;
        match wrong {
            Some(failure) => Err(failure),
            None => Ok(stations),
        }
    }

    /// The entry of the tool that the block on a line is made with.
    fn tool_on(&self, path: &Path, line: usize) -> Result<usize, CutFailure> {
        let number = path.tool_on(line);
        let of = |number: Option<u32>| self.tools.iter().position(|tool| tool.number == number);
        let own = number.and_then(|number| of(Some(number)));
        own.or_else(|| of(None)).ok_or(match number {
            Some(number) => CutFailure::UnknownTool { line, number },
            None => CutFailure::NoTool { line },
        })
    }

    fn drive(
        &self,
        path: &Path,
        motion: &Move,
        tool: &Result<usize, CutFailure>,
    ) -> Result<Drive, CutFailure> {
        let tool = tool.clone()?;
        let line = motion.line;
        let missing = |what, help| CutFailure::Missing { line, what, help };
        let spindle = path.spindle_on(line);
        let said = match spindle.rotation {
            SpindleRotation::Clockwise => Some(Rotation::Clockwise),
            SpindleRotation::CounterClockwise => Some(Rotation::CounterClockwise),
            SpindleRotation::Stopped => None,
        };
        let rotation = self.rotation.or(said).ok_or_else(|| {
            missing(
                "the tool cuts and the spindle does not turn",
                "add M3 or M4 to the program, or give the sense of rotation",
            )
        })?;
        let rpm = self
            .rpm
            .or(spindle.speed.and(spindle.rpm()).filter(|rpm| *rpm > 0.0));
        let rpm = rpm.ok_or_else(|| {
            missing(
                "the tool cuts and no speed of the spindle is known (S with G97)",
                "add the S word to the program, or give the speed",
            )
        })?;
        let per_turn = motion.feed_mm_per_revolution(rpm).ok_or_else(|| {
            missing(
                "the tool cuts and no feed is known (F)",
                "add the F word to the program",
            )
        })?;
        Ok(Drive {
            tool,
            rotation,
            rpm,
            per_tooth_mm: per_turn / self.tools[tool].tool.teeth() as f64,
        })
    }

    /// What no such cut should be.
    fn look_at(
        &self,
        station: &CutStation,
        engagement: &Engagement,
        drive: &Drive,
        feed: Feed,
        line: usize,
        findings: &mut Findings,
    ) {
        let tool = &self.tools[drive.tool];
        let chip = feed.level_mm.hypot(feed.down_mm);
        if let Some(most) = tool.max_chip_mm
            && chip > most
        {
            findings.add(CutFindingKind::ThickChip, line, chip, || {
                format!("{chip:.4} mm per tooth; the tool's maker allows {most} mm")
            });
        }
        if let Some((least, most)) = tool.law.known_between_mm() {
            let thickest = thickest_chip_mm(engagement, &feed, &tool.tool);
            let beyond = larger(thickest / most, least / thickest);
            if thickest > 0.0 && beyond > 1.0 {
                findings.add(CutFindingKind::OutsideTheLaw, line, beyond, || {
                    format!(
                        "chips of at most {thickest:.4} mm; the law of the material was measured from {least} to {most} mm: the force is a guess"
                    )
                });
            }
        }
        if let Some(length) = tool.flute_length_mm
            && station.depth_mm > length
        {
            let depth = station.depth_mm;
            findings.add(CutFindingKind::ShortEdges, line, depth, || {
                format!("{depth:.2} mm deep; the edges are {length} mm long")
            });
        }
        if let Some(curve) = &self.spindle
            && let Some(found) = curve.exceeded_by(drive.rpm, 1e3 * station.torque_n_m)
        {
            let power = station.torque_n_m * drive.rpm * TAU / 60.0;
            findings.add(CutFindingKind::Spindle, line, power, || found.to_string());
        }
        let full = |c: &Contact| c.edge == Edge::End && c.exit - c.entry > 0.999 * TAU;
        if feed.down_mm > 0.0 && engagement.contacts.iter().any(full) {
            findings.add(CutFindingKind::Plunge, line, feed.down_mm, || {
                format!(
                    "the tool plunges with {:.4} mm per tooth: its end must cut at the centre",
                    feed.down_mm
                )
            });
        }
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

/// Of less the stock takes x of the part for the feed.
const NO_DIRECTION: f64 = 1e-9;

/// Begins a move with what acted at the end of the one before: short moves have one station, at their end, and the load
/// does not jump from each to the next.
fn join(before: Option<&Vec<CutStation>>, stations: &mut Vec<CutStation>) {
    let last = before.and_then(|stations| stations.last());
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
