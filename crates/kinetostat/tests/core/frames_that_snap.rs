//! Lee's frame and Williams' toggle: plane frames that snap, as chains of links in segments with a
//! dead load at an inner node and the end held, followed around their limit points.
//!
//! Published: Lee's frame (two members of 120 cm, pinned at both ends, load 24 cm from the corner;
//! E = 720 kN/cm^2, A = 6 cm^2, I = 2 cm^4) has its first limit load at 1.85 to 1.86 kN and then snaps
//! back (S. L. Lee, F. S. Manuel and E. C. Rossow, J. Eng. Mech. Div. ASCE 94 (1968) 521-547;
//! K. H. Schweizerhof and P. Wriggers, Comput. Methods Appl. Mech. Eng. 59 (1986) 261-279; J. C. Simo
//! and L. Vu-Quoc, ibid. 58 (1986) 79-116; the same frame is NAFEMS test NL7). Williams' toggle (half
//! span 12.943 in, rise 0.386 in, EI = 9.27e3 lb in^2, EA = 1.885e6 lb, both feet clamped) snaps
//! through at about 34 lb (F. W. Williams, Q. J. Mech. Appl. Math. 17 (1964) 451-469; R. D. Wood and
//! O. C. Zienkiewicz, Comput. Struct. 7 (1977) 725-735). These are values read from curves, two digits;
//! therefore the same frames are also solved here as planar elasticas with axial strain, by shooting,
//! which shares nothing with the library.

use kinetostat::{
    BeamSection, Chain, ChainProblem, CurveSettings, EndCondition, LinkSpec, Load, Parameter, Pose,
    Prescribed, Settings, Wrench,
    continuation::{Curves, LoadPattern, SpecialKind},
    follow, solve_chain,
};
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4, vector};

/// A plane frame: straight members one after another from the origin.
pub struct PlaneFrame {
    /// Bending stiffness N m^2 and axial stiffness N.
    ei: f64,
    ea: f64,
    /// Per member: turn before it (rad), length (m), segments in the smallest chain.
    members: [(f64, f64, usize); 3],
    /// The load acts downwards after this member.
    loaded: usize,
    /// Both ends on hinges, or both clamped.
    pinned: bool,
}

/// Centimetres and kilonewtons of the sources, in m and N.
pub fn lees_frame() -> PlaneFrame {
    let right = std::f64::consts::FRAC_PI_2;
    PlaneFrame {
        ei: 720e7 * 2e-8,
        ea: 720e7 * 6e-4,
        members: [(right, 1.2, 5), (-right, 0.24, 1), (0.0, 0.96, 4)],
        loaded: 1,
        pinned: true,
    }
}

pub const INCH: f64 = 0.0254;
pub const POUND: f64 = 4.448_221_615_260_5;

/// Inches and pounds of the sources, in m and N.
pub fn williams_toggle(rise: f64) -> PlaneFrame {
    let half = 12.943_f64;
    let (angle, length) = (rise.atan2(half), half.hypot(rise) * INCH);
    PlaneFrame {
        ei: 9.27e3 * POUND * INCH * INCH,
        ea: 1.885e6 * POUND,
        members: [
            (angle, length, 2),
            (-2.0 * angle, 0.5 * length, 1),
            (0.0, 0.5 * length, 1),
        ],
        loaded: 0,
        pinned: false,
    }
}

impl PlaneFrame {
    fn end(&self) -> (f64, f64, f64) {
        let (mut x, mut y, mut angle) = (0.0, 0.0, 0.0_f64);
        for (turn, length, _) in self.members {
            angle += turn;
            (x, y) = (x + length * angle.cos(), y + length * angle.sin());
        }
        (x, y, angle)
    }

    /// As a chain; out of its plane it is a thousand times stiffer, so that it stays there.
    pub fn chain(&self, refined: usize) -> Chain {
        let inertia = 1e-6;
        let modulus = self.ei / inertia;
        let section = BeamSection {
            youngs_modulus: modulus,
            shear_modulus: modulus,
            area: self.ea / modulus,
            second_moment_y: 1e3 * inertia,
            second_moment_z: inertia,
            torsion_constant: 1e3 * inertia,
        };
        let mut b = Chain::builder("frame");
        if self.pinned {
            b = b.passive("foot", kinetostat::MotionKind::Revolute, Vector3::z(), 0.0);
        }
        for (k, (turn, length, segments)) in self.members.into_iter().enumerate() {
            let link = LinkSpec::beam(section, length).segments(segments * refined);
            b = b
                .rigid(Pose::rotation(Vector3::z() * turn))
                .link_with(&format!("member {k}"), &link);
            if k == self.loaded {
                b = b.node("load");
            }
        }
        b.build().unwrap()
    }

    /// Equilibria of the chain by its load (N), from none on.
    pub fn follow<'a>(&self, chain: &'a Chain, settings: &CurveSettings) -> Curves<'a> {
        let (x, y, angle) = self.end();
        let place = Pose::new(vector![x, y, 0.0], Vector3::z() * angle);
        let mut end = EndCondition::pose(place);
        if self.pinned {
            end.prescribed[5] = Prescribed::Wrench;
        }
        let problem = ChainProblem::new(chain, end);
        let down = Wrench::new(vector![0.0, -1.0, 0.0], Vector3::zeros());
        let pattern = LoadPattern {
            loads: vec![Load::dead(chain.node("load").unwrap(), down)],
            ..LoadPattern::default()
        };
        let start = solve_chain(&problem, &Settings::default()).unwrap();
        follow(&problem, &Parameter::Load(pattern), &start, 0.0, settings).unwrap()
    }
}

/// Load (N) and deflection of the loaded point downwards (m) at the limit points of the load.
pub type Limits = Vec<(f64, f64)>;

/// Limit points of the load along the chain's curve, in order of arc length.
pub fn limits_of_chain(frame: &PlaneFrame, refined: usize, settings: &CurveSettings) -> Limits {
    let chain = frame.chain(refined);
    let curves = frame.follow(&chain, settings);
    let mut found: Vec<(f64, f64, f64)> = curves
        .specials
        .iter()
        .filter(|s| s.kind == SpecialKind::LoadLimit)
        .map(|s| {
            // Nearest point of the curve tells the order.
            let points = &curves.branches[0].points;
            let near = points.iter().min_by(|a, b| {
                let d = |p: &kinetostat::continuation::CurvePoint| {
                    (p.conjugate - s.point.conjugate).abs() / frame.end().0
                        + (p.parameter - s.point.parameter).abs() / settings.range.1
                };
                d(a).total_cmp(&d(b))
            });
            (near.unwrap().arc, s.point.parameter, s.point.conjugate)
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, p, w)| (p, w)).collect()
}

/// The same frame as a planar elastica with axial strain, by shooting from its foot: unknown are the
/// reaction (N) and the foot's angle or moment; Runge-Kutta of fourth order.
struct Shot<'f> {
    frame: &'f PlaneFrame,
    force: f64,
    length: f64,
    drop: std::cell::Cell<f64>,
}

impl<'f> Shot<'f> {
    fn new(frame: &'f PlaneFrame) -> Self {
        let length: f64 = frame.members.iter().map(|m| m.1).sum();
        Self {
            frame,
            force: frame.ei / (length * length),
            length,
            drop: std::cell::Cell::new(0.0),
        }
    }

    /// Residual of the far end, in natural units, for `(R_x, R_y, angle or moment, load)` in natural
    /// units.
    fn residual(&self, u: &Vector4<f64>) -> Vector3<f64> {
        let f = self.frame;
        let (rx, ry) = (u[0] * self.force, u[1] * self.force);
        let mut state = Vector4::zeros(); // x, y, angle, moment
        if f.pinned {
            state[2] = u[2];
        } else {
            state[3] = u[2] * f.ei / self.length;
        }
        // Force of what lies ahead on what lies behind.
        let (nx, mut ny) = (-rx, -ry);
        let mut undeformed = 0.0_f64;
        let mut height = 0.0;
        for (k, (turn, length, _)) in f.members.into_iter().enumerate() {
            state[2] += turn;
            undeformed += turn;
            height += length * undeformed.sin();
            let rate = |s: &Vector4<f64>| {
                let (sin, cos) = s[2].sin_cos();
                let stretch = 1.0 + (nx * cos + ny * sin) / f.ea;
                let (dx, dy) = (stretch * cos, stretch * sin);
                Vector4::new(dx, dy, s[3] / f.ei, dy * nx - dx * ny)
            };
            let steps = 60;
            let h = length / f64::from(steps);
            for _ in 0..steps {
                let a = rate(&state);
                let b = rate(&(state + a * (0.5 * h)));
                let c = rate(&(state + b * (0.5 * h)));
                let d = rate(&(state + c * h));
                state += (a + (b + c) * 2.0 + d) * (h / 6.0);
            }
            if k == f.loaded {
                self.drop.set(height - state[1]);
                ny += u[3] * self.force;
            }
        }
        let (x, y, angle) = f.end();
        let third = if f.pinned {
            state[3] * self.length / f.ei
        } else {
            state[2] - angle
        };
        Vector3::new(
            (state[0] - x) / self.length,
            (state[1] - y) / self.length,
            third,
        )
    }

    /// Derivative, 3 x 4, by central differences of fourth order.
    fn slope(&self, u: &Vector4<f64>) -> nalgebra::Matrix3x4<f64> {
        let mut slope = nalgebra::Matrix3x4::zeros();
        for k in 0..4 {
            let at = |s: f64| {
                let mut near = *u;
                near[k] += s * 1e-4;
                self.residual(&near)
            };
            let column = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12e-4;
            slope.set_column(k, &column);
        }
        slope
    }

    /// Unit tangent of the solutions, along `guide`.
    fn tangent(&self, u: &Vector4<f64>, guide: &Vector4<f64>) -> Vector4<f64> {
        let s = self.slope(u);
        let minor = |k: usize| {
            let columns: Vec<usize> = (0..4).filter(|&c| c != k).collect();
            let m = Matrix3::from_fn(|r, c| s[(r, columns[c])]);
            m.determinant() * if k.is_multiple_of(2) { 1.0 } else { -1.0 }
        };
        let t = Vector4::from_fn(|k, _| minor(k)).normalize();
        if t.dot(guide) < 0.0 { -t } else { t }
    }

    /// Newton back to the solutions, across `t`; `None` if that leads elsewhere.
    fn correct(&self, u: &Vector4<f64>, t: &Vector4<f64>, size: f64) -> Option<Vector4<f64>> {
        let guess = u + t * size;
        let mut u = guess;
        for _ in 0..10 {
            let (residual, s) = (self.residual(&u), self.slope(&u));
            let a = Matrix4::from_fn(|r, c| if r < 3 { s[(r, c)] } else { t[c] });
            let b = Vector4::new(
                -residual[0],
                -residual[1],
                -residual[2],
                t.dot(&(guess - u)),
            );
            let step = a.lu().solve(&b)?;
            u += step;
            if step.norm() < 1e-9 * (1.0 + u.norm()) {
                return ((u - guess).norm() < 0.2 * size + 1e-9).then_some(u);
            }
        }
        None
    }

    /// Limit points of the load until the loaded point has come down by `most` (m).
    fn limits(&self, most: f64) -> Limits {
        let (mut u, mut size) = (Vector4::zeros(), 0.05);
        let mut t = self.tangent(&u, &Vector4::w());
        let mut found = Vec::new();
        for _ in 0..4000 {
            let Some(next) = self.correct(&u, &t, size) else {
                size *= 0.5;
                assert!(size > 1e-7, "the elastica is lost at {u}");
                continue;
            };
            let ahead = self.tangent(&next, &t);
            if ahead.dot(&t) < 0.95 {
                size *= 0.5;
                continue;
            }
            if ahead[3] * t[3] < 0.0 {
                let (mut low, mut high, mut at) = (0.0, size, u);
                for _ in 0..30 {
                    let middle = 0.5 * (low + high);
                    at = self.correct(&u, &t, middle).expect("between two solutions");
                    if self.tangent(&at, &t)[3] * t[3] > 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                self.residual(&at);
                found.push((at[3] * self.force, self.drop.get()));
            }
            (u, t, size) = (next, ahead, 1.3 * size);
            self.residual(&u);
            if self.drop.get() > most {
                return found;
            }
        }
        panic!("the elastica does not come down to {most} m");
    }
}

/// Limit points of the elastica until the loaded point has come down by `most` (m).
pub fn limits_by_shooting(frame: &PlaneFrame, most: f64) -> Limits {
    Shot::new(frame).limits(most)
}

pub fn lee_settings() -> CurveSettings {
    let mut settings = CurveSettings::within(-3000.0, 3000.0);
    settings.conjugate_range = (-0.01, 0.9);
    settings.points = 300;
    settings
}

pub fn williams_settings() -> CurveSettings {
    let mut settings = CurveSettings::within(-1.0, 100.0 * POUND);
    settings.conjugate_range = (-1e-4, 0.75 * INCH);
    settings.points = 300;
    settings
}

/// Largest difference of two lists of limit points, loads and deflections, relative to the first.
pub fn apart(found: &Limits, exact: &Limits) -> [(f64, f64); 2] {
    assert!(found.len() >= 2 && exact.len() == 2, "{found:?} {exact:?}");
    [0, 1].map(|k| {
        let load = (found[k].0 - exact[k].0).abs() / exact[0].0;
        let deflection = (found[k].1 - exact[k].1).abs() / exact[0].1;
        (load, deflection)
    })
}

#[test]
fn lees_frame_snaps_back() {
    let frame = lees_frame();
    let exact = limits_by_shooting(&frame, 0.75);
    // Published: 1.85 to 1.86 kN.
    assert!((1845.0..1865.0).contains(&exact[0].0), "{exact:?}");
    for (refined, [first, second]) in [
        (1, [(1e-4, 3e-3), (2e-2, 2e-3)]),
        (2, [(5e-5, 2e-4), (2e-3, 3e-4)]),
    ] {
        let limits = limits_of_chain(&frame, refined, &lee_settings());
        let off = apart(&limits, &exact);
        let label = format!(
            "{} segments: {limits:?}, elastica {exact:?}, {off:?}",
            10 * refined
        );
        println!("{label}");
        assert!(off[0].0 < first.0 && off[0].1 < first.1, "{label}");
        assert!(off[1].0 < second.0 && off[1].1 < second.1, "{label}");
    }
}

/// Between its limits the load's point of Lee's frame comes back: under a prescribed deflection the
/// frame jumps as well.
#[test]
fn lees_frame_has_limits_of_the_deflection_too() {
    let frame = lees_frame();
    let chain = frame.chain(1);
    let curves = frame.follow(&chain, &lee_settings());
    let count = |kind| curves.specials.iter().filter(|s| s.kind == kind).count();
    assert_eq!(count(SpecialKind::LoadLimit), 2);
    assert_eq!(count(SpecialKind::DisplacementLimit), 2);
    // Stable up to the first limit, and again after the second.
    let points = &curves.branches[0].points;
    assert!(points.iter().filter(|p| p.dead_load.stable).count() > 10);
    assert!(points.last().unwrap().dead_load.stable);
}

#[test]
fn williams_toggle_snaps_through() {
    let frame = williams_toggle(0.386);
    let exact = limits_by_shooting(&frame, 0.6 * INCH);
    // Published: about 34 lb.
    assert!((33.5..34.5).contains(&(exact[0].0 / POUND)), "{exact:?}");
    for (refined, most) in [(2, 3e-3), (4, 2e-4)] {
        let limits = limits_of_chain(&frame, refined, &williams_settings());
        let off = apart(&limits, &exact);
        let pounds = |l: &Limits| -> Vec<(f64, f64)> {
            l.iter().map(|l| (l.0 / POUND, l.1 / INCH)).collect()
        };
        let label = format!(
            "{} segments: {:?} lb, in; elastica {:?}; {off:?}",
            4 * refined,
            pounds(&limits),
            pounds(&exact)
        );
        println!("{label}");
        assert!(off.iter().all(|o| o.0 < most && o.1 < most), "{label}");
    }
}
