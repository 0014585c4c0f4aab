//! Mean forces of one tool, law and feed from a table.
//!
//! The mean over a patch is an integral over it, so it is a difference of the integral up to its corners. Along a program
//! the feed seldom changes and the engagement always: with that integral in a table, a force costs four places of it.

use std::f64::consts::TAU;

use crate::engagement::{Contact, Edge, Engagement};
use crate::error::Result;
use crate::law::ForceLaw;
use crate::milling::chip::{Chips, Feed};
use crate::milling::cut::{CutForce, Rotation};
use crate::tool::{Meridian, Piece, Tool};

/// Angles of the table over one turn, taken linearly: an error of some 1e-5 of the force of a slot, and of 5e-4 where the
/// force of the edge begins at once inside a step (run-out, linear law).
const ANGLES: usize = 1024;

/// Angles of the normal from the pole to the cylinder, taken by cubics.
const NORMALS: usize = 32;

/// Integrals over the angle of the force per width of edge: `[F_x, F_y, F_z, cos phi F_z, sin phi F_z, F_t]`.
type Sums = [f64; 6];

/// A row of the corner: force and moment up to each angle, and their growth per step of the normal.
#[derive(Clone, Debug)]
struct Row {
    value: Vec<[f64; 6]>,
    growth: Vec<[f64; 6]>,
}

/// Mean forces of one tool with one law and one feed across the axis.
///
/// ```
/// use kinetostat_cutting::{Engagement, Feed, Kienzle, MeanTable, Milling, Rotation, Shape, Side, Tool};
///
/// let tool = Tool::new(Shape::Ball, 6.0, 2)?;
/// let law = Kienzle::new([780.0, 300.0, 120.0], [0.23, 0.4, 0.3])?;
/// let table = MeanTable::new(&tool, &law, 0.05, Rotation::Clockwise)?; // mm per tooth
/// let cut = Engagement::straight(3.0, 2.0, 1.5, Side::Right)?;
/// let (by_table, by_sums) = (table.mean(&cut), Milling::new(&tool, &law, &cut, Feed::level(0.05)?).mean());
/// assert!((by_table.force_n - by_sums.force_n).norm() < 2e-4 * by_sums.force_n.norm());
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeanTable {
    tool: Tool,
    rotation: Rotation,
    /// Above the corner: up to each angle.
    straight: Vec<Sums>,
    /// Integrals on the corner, up to each angle of the normal and each angle: with width, radius and height, and their
    /// growth from one angle of the normal to the next.
    corner: Vec<Row>,
}

impl MeanTable {
    /// The table of a feed per tooth across the axis, mm.
    ///
    /// # Errors
    /// As [`Feed::level`].
    pub fn new<L: ForceLaw + ?Sized>(
        tool: &Tool,
        law: &L,
        feed_per_tooth_mm: f64,
        rotation: Rotation,
    ) -> Result<Self> {
        let feed = Feed::level(feed_per_tooth_mm)?;
        let chips = Chips::new(tool);
        let row = |place: &Meridian| up_to_each_angle(&chips, law, &feed, place);
        let mut straight = Vec::new();
        let mut corner = Vec::new();
        let end = tool.corner_radius_mm();
        // Any height above the corner has the same chips.
        for (piece, from, _) in Piece::between(tool, end, end + 1.0) {
            straight = row(&piece.point(from));
        }
        if end > 0.0 {
            corner = corner_table(tool, end, row);
        }
        Ok(Self {
            tool: *tool,
            rotation,
            straight,
            corner,
        })
    }

    /// Mean force over the revolution, as [`crate::Milling::mean`] with this feed.
    #[must_use]
    pub fn mean(&self, engagement: &Engagement) -> CutForce {
        match self.rotation {
            Rotation::Clockwise => self.clockwise(&engagement.contacts),
            Rotation::CounterClockwise => {
                self.clockwise(&engagement.mirrored().contacts).mirrored()
            }
        }
    }

    fn clockwise(&self, contacts: &[Contact]) -> CutForce {
        let mut sum = CutForce::default();
        // The flat end bears nothing without a feed down the axis.
        for contact in contacts.iter().filter(|contact| contact.edge == Edge::Side) {
            for (piece, from, to) in Piece::between(&self.tool, contact.from_mm, contact.to_mm) {
                sum += match piece {
                    Piece::Straight { .. } => {
                        let place = piece.point(0.5 * (from + to));
                        let of = over_arc(&self.straight, contact);
                        at_place(of, &place, place.width * (to - from))
                    }
                    Piece::Corner { .. } => {
                        let upper = self.up_to(Piece::parameter_share(to), contact);
                        let lower = self.up_to(Piece::parameter_share(from), contact);
                        in_force(std::array::from_fn(|i| upper[i] - lower[i]))
                    }
                };
            }
        }
        sum * TAU.recip()
    }

    /// The integral over an arc and the corner up to a share of its normals.
    fn up_to(&self, share: f64, contact: &Contact) -> [f64; 6] {
        let at = share.clamp(0.0, 1.0) * NORMALS as f64;
        let row = (at as usize).min(NORMALS - 1);
        let u = at - row as f64;
        let (a, b) = (&self.corner[row], &self.corner[row + 1]);
        let [value_a, growth_a, value_b, growth_b] =
            [&a.value, &a.growth, &b.value, &b.growth].map(|table| over_arc(table, contact));
        std::array::from_fn(|i| {
            let step = value_b[i] - value_a[i];
            let (first, last) = (growth_a[i] - step, step - growth_b[i]);
            value_a[i] + u * (step + (1.0 - u) * (first * (1.0 - u) + last * u))
        })
    }
}

/// Integrals from angle 0 to each angle of the table, of all teeth.
fn up_to_each_angle<L: ForceLaw + ?Sized>(
    chips: &Chips,
    law: &L,
    feed: &Feed,
    place: &Meridian,
) -> Vec<Sums> {
    let step = TAU / ANGLES as f64;
    let mut table = Vec::with_capacity(ANGLES + 1);
    let mut sums: Sums = [0.0; 6];
    table.push(sums);
    let at = |phi: f64| {
        let (sin, cos) = phi.sin_cos();
        let mut of: Sums = [0.0; 6];
        for tooth in &chips.teeth {
            let chip = tooth.thickness(feed, place, sin);
            if chip > 0.0 {
                let force = law.edge_force(chip) * tooth.alike;
                let radially = place.cos * force.axial - place.sin * force.radial;
                let z = place.cos * force.radial + place.sin * force.axial;
                of[0] += -force.tangential * cos + radially * sin;
                of[1] += force.tangential * sin + radially * cos;
                of[2] += z;
                of[3] += z * cos;
                of[4] += z * sin;
                of[5] += force.tangential;
            }
        }
        of
    };
    for i in 0..ANGLES {
        // Two nodes of Gauss: nothing is asked for at 0 and at half a turn, where chips begin.
        for node in [0.211_324_865_405_187_1, 0.788_675_134_594_812_9] {
            let of = at(step * (i as f64 + node));
            for (sum, of) in sums.iter_mut().zip(of) {
                *sum += 0.5 * step * of;
            }
        }
        table.push(sums);
    }
    table
}

/// Integrals over the corner up to each angle of the normal, by Simpson's rule.
fn corner_table(tool: &Tool, end: f64, row: impl Fn(&Meridian) -> Vec<Sums>) -> Vec<Row> {
    let mut table: Vec<Row> = Vec::with_capacity(NORMALS + 1);
    for (piece, from, to) in Piece::between(tool, 0.0, end) {
        let step = (to - from) / NORMALS as f64;
        let growth = |share: f64| -> Vec<[f64; 6]> {
            let place = piece.point(from + step * share);
            let of = row(&place).into_iter();
            of.map(|of| at_place(of, &place, place.width * step))
                .map(|force| {
                    let (f, m) = (force.force_n, force.moment_n_mm);
                    [f.x, f.y, f.z, m.x, m.y, m.z]
                })
                .collect()
        };
        table.push(Row {
            value: vec![[0.0; 6]; ANGLES + 1],
            growth: growth(0.0),
        });
        for i in 0..NORMALS {
            let (middle, last) = (growth(i as f64 + 0.5), growth(i as f64 + 1.0));
            let before = &table[i];
            let value = (0..=ANGLES).map(|a| {
                std::array::from_fn(|k| {
                    let sum = before.growth[a][k] + 4.0 * middle[a][k] + last[a][k];
                    before.value[a][k] + sum / 6.0
                })
            });
            let value = value.collect();
            table.push(Row {
                value,
                growth: last,
            });
        }
    }
    table
}

/// Difference of a table between the ends of an arc.
fn over_arc(table: &[[f64; 6]], contact: &Contact) -> [f64; 6] {
    let whole = table[ANGLES];
    let up_to = |phi: f64| -> [f64; 6] {
        let turns = (phi / TAU).floor();
        let at = (phi / TAU - turns) * ANGLES as f64;
        let i = (at as usize).min(ANGLES - 1);
        let part = at - i as f64;
        let (a, b) = (&table[i], &table[i + 1]);
        std::array::from_fn(|k| turns * whole[k] + a[k] + part * (b[k] - a[k]))
    };
    let (a, b) = (up_to(contact.entry), up_to(contact.exit));
    std::array::from_fn(|k| b[k] - a[k])
}

/// Force and moment of integrals at one place of the meridian, times a width.
fn at_place(of: Sums, place: &Meridian, width: f64) -> CutForce {
    let [x, y, z, cos_z, sin_z, tangential] = of;
    let (r, h) = (place.radius, place.height);
    in_force([
        x,
        y,
        z,
        r * cos_z - h * y,
        h * x - r * sin_z,
        r * tangential,
    ]) * width
}

fn in_force([x, y, z, about_x, about_y, about_z]: [f64; 6]) -> CutForce {
    CutForce {
        force_n: nalgebra::Vector3::new(x, y, z),
        moment_n_mm: nalgebra::Vector3::new(about_x, about_y, about_z),
    }
}
