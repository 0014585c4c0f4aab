//! The load on the tool along a program.
//!
//! Cutting forces act on feed moves, not on rapids. In the milling frame the radial and the
//! tangential force turn with the feed direction [R 7.17, with the sign of the errata]:
//!
//! ```text
//! f = F_r e_r + F_t e_t + F_a z,   e_t along the feed (seen along the tool axis z), e_r = e_t x z
//! ```
//!
//! so that on a counter-clockwise circle `e_r` points outwards. If the program turns the tool, z is the direction from its tip to its
//! holder and the feed is seen along that. While the tool turns in place (`G1 C90` alone) the feed counts as that of the path around, over
//! 0.05 mm before and behind; that direction stays fixed in the part, and so turns with a table, however the turn is divided into blocks.
//! If the path turns back there it has no direction, and the axial force alone acts. At a gentle corner the load turns over the last and
//! first millimetres of the two moves; at a sharp one it turns at once, and what it is while the written program steps there is a matter of
//! reading ([`crate::load::law::CornerLoad`]).

use std::borrow::Cow;

use kinetostat::Wrench;
use kinetostat_program::{Curve, Move, MoveKind, Path, Turning};
use nalgebra::{Rotation3, Vector3};

use crate::cut::profile::{CutAxes, ForceAlongPath, Scale};
use crate::load::headings::{Headings, heading_on, headings, tool_frame};
use crate::load::law::{CuttingLoad, LoadAxes, ProgramLoad, Tool, tool_on};
use crate::placement::Placement;
use crate::profile::Profile;

/// Forces of the cut.
#[derive(Clone, Debug)]
pub(crate) struct OfCut<'a> {
    pub profile: Cow<'a, Profile<6>>,
    pub scale: Scale,
    /// Length within which the places of the forces are known, mm.
    pub resolution_mm: f64,
    pub axes: CutAxes,
}

/// A [`ProgramLoad`] along one path.
#[derive(Clone, Debug)]
pub struct LoadAlongPath<'a> {
    load: ProgramLoad,
    path: &'a Path,
    tools: &'a [Tool<'a>],
    pub(crate) cut: Option<OfCut<'a>>,
    /// The part of a stated load that acts; all of it on moves of which nothing is said.
    part: Option<Profile<1>>,
    headings: Vec<Headings>,
}

/// A wrench in axes of the feed, in those of the part.
fn headed(wrench: &Wrench, heading: Option<f64>) -> Wrench {
    match heading {
        Some(angle) => wrench.rotated(&Rotation3::from_axis_angle(&Vector3::z_axis(), angle)),
        // Along the tool axis only the axial part has a direction.
        None => Wrench::new(
            Vector3::z() * wrench.force().z,
            Vector3::z() * wrench.moment().z,
        ),
    }
}

impl<'a> LoadAlongPath<'a> {
    /// Prepares the headings of all moves.
    #[must_use]
    pub fn new(load: ProgramLoad, path: &'a Path) -> Self {
        Self::with_tools(load, path, &[])
    }

    /// Load along a path with a load for each tool on its own blocks; `load` is that of blocks without one of these
    /// tools.
    #[must_use]
    pub fn with_tools(load: ProgramLoad, path: &'a Path, tools: &'a [Tool<'a>]) -> Self {
        let mut along = Self {
            load,
            path,
            tools,
            cut: None,
            part: None,
            headings: Vec::new(),
        };
        if along.load.turns() || tools.iter().any(|tool| tool.load.turns()) {
            along.headings = headings(path, |i| along.load_of(i));
        }
        along
    }

    /// Adds the forces of the cut, for loads that are [`CuttingLoad::FromCut`].
    #[must_use]
    pub fn with_cut(mut self, cut: Option<&'a ForceAlongPath>) -> Self {
        self.cut = cut.map(|cut| {
            let (vertices, axes) = cut.of_load();
            OfCut {
                profile: Cow::Borrowed(&vertices.profile),
                scale: vertices.scale,
                resolution_mm: cut.resolution_mm(),
                axes,
            }
        });
        self
    }

    /// Replaces the profile of the cut.
    pub(crate) fn with_profile(mut self, profile: Profile<6>) -> Self {
        if let Some(cut) = &mut self.cut {
            cut.profile = Cow::Owned(profile);
        }
        self
    }

    pub(crate) fn with_part(mut self, part: Option<Profile<1>>) -> Self {
        self.part = part;
        self
    }

    pub(crate) fn path(&self) -> &'a Path {
        self.path
    }

    /// The load of blocks without a tool that has its own.
    pub(crate) fn base_load(&self) -> &ProgramLoad {
        &self.load
    }

    /// The tool that a move is made with, where several are named.
    #[must_use]
    pub fn tool_of(&self, move_index: usize) -> Option<&Tool<'a>> {
        tool_on(self.tools, self.path, self.path.moves[move_index].line)
    }

    /// Load on the tool of a move.
    pub(crate) fn load_of(&self, move_index: usize) -> &ProgramLoad {
        self.tool_of(move_index)
            .map_or(&self.load, |tool| &tool.load)
    }

    /// Wrench on the tool's tip (base axes, N, N m) at a share of a move.
    #[must_use]
    pub fn wrench(&self, placement: &Placement, move_index: usize, share: f64) -> Wrench {
        let heading = match self.load_of(move_index).turns() {
            true => self.heading_at(move_index, share),
            false => None,
        };
        self.wrench_headed(placement, move_index, share, heading)
    }

    /// Wrench on the tool's tip at a share of a move, as [`Self::wrench`], of a cut in another direction
    /// (program axes).
    #[must_use]
    pub fn wrench_towards(
        &self,
        placement: &Placement,
        move_index: usize,
        share: f64,
        direction: &Vector3<f64>,
    ) -> Wrench {
        let along = heading_on(self.path, move_index, share, direction.try_normalize(1e-9));
        self.wrench_headed(placement, move_index, share, along)
    }

    /// Shares of a move at which the load or its slope jumps: where turning at gentle corners begins and
    /// ends, and where an arc passes the height of the load. (A straight move passes it once, between
    /// ends with different loads; the writer finds that by halving.)
    #[must_use]
    pub fn breaks(&self, move_index: usize) -> Vec<f64> {
        let motion = &self.path.moves[move_index];
        let load = self.load_of(move_index);
        let mut shares = Vec::new();
        if let Some(z) = load.below_z_mm
            && motion.curve != Curve::Line
        {
            shares.extend(motion.shares_at(2, &[z]));
        }
        if let (CuttingLoad::FromCut { .. }, Some(cut)) = (load.cutting, &self.cut) {
            shares.extend(cut.profile.breaks(move_index));
        }
        if let Some(part) = &self.part {
            shares.extend(part.breaks(move_index));
        }
        let h = self.headings.get(move_index).copied().unwrap_or_default();
        let (length, zone) = (motion.length_mm(), load.turning_length_mm);
        if length > 2.0 * zone {
            if h.lag_start != 0.0 {
                shares.push(zone / length);
            }
            if h.lag_end != 0.0 {
                shares.push(1.0 - zone / length);
            }
        }
        shares
    }

    /// True if only the place changes along a move: it is straight, and the load on it is constant.
    pub(crate) fn is_steady(&self, move_index: usize) -> bool {
        let motion = &self.path.moves[move_index];
        let load = self.load_of(move_index);
        let straight = motion.curve == Curve::Line && motion.tool_turn.is_none();
        let h = self.headings.get(move_index).copied().unwrap_or_default();
        let turns = h.lag_start != 0.0 || h.lag_end != 0.0;
        let comes_or_goes = |part: &Profile<1>| !part.of(move_index).is_empty();
        let varies = matches!(load.cutting, CuttingLoad::FromCut { .. })
            || self.part.as_ref().is_some_and(comes_or_goes);
        let passes = |z: f64| (motion.start.z >= z) != (motion.end.z >= z);
        straight && !turns && !varies && !load.below_z_mm.is_some_and(passes)
    }

    fn wrench_headed(
        &self,
        placement: &Placement,
        move_index: usize,
        share: f64,
        heading: Option<f64>,
    ) -> Wrench {
        let load = self.load_of(move_index);
        let motion = &self.path.moves[move_index];
        let position = motion.point(share);
        let outside = load.below_z_mm.is_some_and(|z| position.z >= z);
        let part = self.part.as_ref().and_then(|p| p.at(move_index, share));
        let part = match part {
            Some([part]) => part,
            None if outside => 0.0,
            None => 1.0,
        };
        if motion.kind == MoveKind::Rapid || part == 0.0 {
            return Wrench::zero();
        }
        let place = placement.on(motion, share);
        let in_base = |w: Wrench| w.rotated(&place.base_from_part.rotation.to_rotation_matrix());
        // Radial, tangential and axial belong to the tool, whichever way the program turns it.
        let of_tool = |w: Wrench| match motion.tool_turn {
            None => w,
            Some(_) => {
                let frame = tool_frame(self.path, move_index, share);
                w.rotated(&frame.to_rotation_matrix())
            }
        };
        let full = match load.cutting {
            CuttingLoad::None => Wrench::zero(),
            CuttingLoad::Constant {
                axes: LoadAxes::Base,
                wrench,
            } => wrench,
            CuttingLoad::Constant {
                axes: LoadAxes::Tool,
                wrench,
            } => {
                let orientation = placement.orientation_on(motion, share);
                wrench.rotated(&orientation.to_rotation_matrix())
            }
            CuttingLoad::Constant {
                axes: LoadAxes::Feed,
                wrench,
            } => in_base(of_tool(headed(&wrench, heading))),
            CuttingLoad::FromCut { .. } => {
                let Some(cut) = &self.cut else {
                    return Wrench::zero();
                };
                let wrench = cut.profile.at(move_index, share);
                let wrench = wrench.map_or_else(Wrench::zero, |wrench| Wrench(wrench.into()));
                in_base(match cut.axes {
                    CutAxes::Part => wrench,
                    // Along the tool axis, forces of the cut are in axes of the part.
                    CutAxes::Feed => of_tool(headed(&wrench, heading.or(Some(0.0)))),
                })
            }
            CuttingLoad::Milling {
                radial,
                tangential,
                axial,
            } => {
                let mut force = Vector3::new(0.0, 0.0, axial);
                if let Some(angle) = heading {
                    let (s, c) = angle.sin_cos();
                    force +=
                        Vector3::new(s, -c, 0.0) * radial + Vector3::new(c, s, 0.0) * tangential;
                }
                in_base(of_tool(Wrench::new(force, Vector3::zeros())))
            }
        };
        Wrench(full.0 * part)
    }

    /// Wrench while the tool stands at a corner at the start of the move and the load turns from that of one place of the path to that
    /// of another: evenly, component by component.
    #[must_use]
    pub fn turning_wrench(
        &self,
        placement: &Placement,
        move_index: usize,
        turning: &Turning,
    ) -> Wrench {
        let before = self.wrench(placement, turning.from_move, turning.from_share);
        let after = self.wrench(placement, move_index, turning.to_share);
        Wrench(before.0.lerp(&after.0, turning.part))
    }

    fn heading_at(&self, move_index: usize, share: f64) -> Option<f64> {
        let motion = &self.path.moves[move_index];
        let h = self.headings.get(move_index).copied().unwrap_or_default();
        let along = h.around.or_else(|| motion.tangent(share));
        let own = heading_on(self.path, move_index, share, along)?;
        let length = motion.length_mm();
        let load = self.load_of(move_index);
        let zone = load.turning_length_mm;
        // Short moves turn evenly over their whole length, long ones near their ends.
        let (start, end) = if length <= 2.0 * zone {
            (1.0 - share, share)
        } else {
            let s = share * length;
            (
                (1.0 - s / zone).max(0.0),
                (1.0 - (length - s) / zone).max(0.0),
            )
        };
        Some(own + h.lag_start * start + h.lag_end * end)
    }

    /// The load in words.
    #[must_use]
    pub fn description(&self) -> String {
        let of_tool =
            |tool: &Tool<'_>| format!("tool {}: {}", tool.number, tool.load.description());
        let all: Vec<String> = match self.tools.is_empty() {
            true => vec![self.load.description()],
            false => self.tools.iter().map(of_tool).collect(),
        };
        all.join("; ") + self.words_of_turning()
    }

    /// Text on the rotation of a load of the feed with the rotary axes of a machine.
    fn words_of_turning(&self) -> &'static str {
        let turns = self.load.turns() || self.tools.iter().any(|tool| tool.load.turns());
        let by_axes = |motion: &Move| {
            let turn = motion.tool_turn.as_ref();
            turn.is_some_and(|turn| turn.rotary.is_some()) && motion.kind == MoveKind::Feed
        };
        let mut moves = self.path.moves.iter().filter(|motion| by_axes(motion));
        if !turns || moves.clone().next().is_none() {
            return "";
        }
        match moves.any(Move::turns_in_place) {
            true => {
                ", all as seen along the tool in the part; while rotary axes turn alone, the feed counts as that of the path around, fixed in the part"
            }
            false => ", all as seen along the tool in the part",
        }
    }
}
