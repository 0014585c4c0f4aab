//! Spatial scene of a drawing: bars, joints, plates and ground marks, in metres and base axes.

use kinetostat::{Anchor, Load, Mechanism, PlatformLoad, model::Kinematics};
use nalgebra::Vector3;

use crate::drawing::Placed;
use crate::drawing::limb::{Run, trace};
use crate::drawing::parts::{Bar, BarKind, Blob, BlobKind, Plate, Scene, Word};
use crate::drawing::symbol::MOTOR;

/// Pixels of the drawing along the diagonal of the machine.
const PIXELS: f64 = 470.0;

/// Maximum number of limbs with names in the drawing.
const MOST_NAMES: usize = 14;

impl Scene {
    /// The machine in a state.
    #[must_use]
    pub fn of(mechanism: &Mechanism, placed: &Placed) -> Self {
        // Symbols are as large as the whole machine asks: the first pass finds that out.
        let first = Self::with_unit(mechanism, placed, 0.0);
        Self::with_unit(mechanism, placed, first.extent() / PIXELS)
    }

    /// Scene with symbols of the size that another scene of the same machine has.
    pub(super) fn with_unit(mechanism: &Mechanism, placed: &Placed, unit: f64) -> Self {
        let mut scene = Self {
            tool: placed.platforms[mechanism.tool()],
            unit,
            ..Self::default()
        };
        let ends = attachments(mechanism);
        let mut points: Vec<Vec<Vector3<f64>>> = vec![Vec::new(); mechanism.platforms().len()];
        for (i, limb) in mechanism.limbs().iter().enumerate() {
            let run = Run {
                limb: i,
                chain: placed.chain(limb),
                from: placed.platforms[limb.from],
                coordinates: &placed.coordinates[i],
                commands: &placed.commands[i],
                start_is_link: ends[limb.from] == 1 || (limb.from != 0 && ends[limb.from] < 3),
                end_is_link: ends[limb.to] < 3,
                on_base: limb.from == 0,
            };
            let found = trace(&mut scene, &run);
            points[limb.from].push(found.start);
            if run.end_is_link {
                let origin = placed.platforms[limb.to].translation.vector;
                let last = Bar::straight(Some(i), found.tip, origin, BarKind::Rigid);
                scene.bars.push(last);
            } else {
                points[limb.to].push(found.end);
            }
            scene.lines_of_loads(mechanism, placed, i);
        }
        scene.struts_between_platforms(mechanism, placed);
        scene.size = scene.extent().max(1e-9);
        scene.leave_out_twins();
        scene.plates_of(mechanism, placed, &points);
        scene.grounds_of(&points[0]);
        scene.words_of(mechanism, placed);
        scene
    }

    /// A side branch is written out and back: one of two bars or joints at one place is enough.
    fn leave_out_twins(&mut self) {
        let near = 1e-6 * self.size;
        let close = |a: &Vector3<f64>, b: &Vector3<f64>| (a - b).norm() < near;
        for i in 0..self.bars.len() {
            for j in 0..i {
                let (a, b) = (&self.bars[i], &self.bars[j]);
                let same =
                    |k: usize| close(&a.ends[0], &b.ends[k]) && close(&a.ends[1], &b.ends[1 - k]);
                let plain = |kind| matches!(kind, BarKind::Rigid | BarKind::Elastic);
                if plain(a.kind) && plain(b.kind) && (same(0) || same(1)) {
                    // The elastic bar is kept.
                    let worse = if a.kind == BarKind::Elastic { j } else { i };
                    self.bars[worse].kind = BarKind::Twice;
                }
            }
        }
        let mut kept: Vec<Blob> = Vec::with_capacity(self.blobs.len());
        for blob in self.blobs.drain(..) {
            let twin = |other: &Blob| {
                other.kind == blob.kind
                    && close(&other.at, &blob.at)
                    && other.axis.cross(&blob.axis).norm() < 1e-6
            };
            let drive = matches!(blob.kind, BlobKind::Motor | BlobKind::Sleeve);
            if drive || !kept.iter().any(twin) {
                kept.push(blob);
            }
        }
        self.blobs = kept;
    }

    /// Diagonal of the box around bars (without rails) and joints, m.
    fn extent(&self) -> f64 {
        let bars = self.bars.iter().filter(|b| b.kind != BarKind::Rail);
        let points = bars
            .flat_map(|b| b.ends)
            .chain(self.blobs.iter().map(|b| b.at));
        let Some((low, high)) = corners(points) else {
            return 1.0;
        };
        let size = (high - low).norm();
        if size > 0.0 { size } else { 1.0 }
    }

    /// Compensators between two points.
    fn lines_of_loads(&mut self, mechanism: &Mechanism, placed: &Placed, limb: usize) {
        if mechanism.loads(limb).is_empty() {
            return;
        }
        let own = &mechanism.limbs()[limb];
        let kinematics = Kinematics::new(
            placed.chain(own),
            &placed.platforms[own.from],
            &placed.coordinates[limb],
            &placed.commands[limb],
        );
        for load in mechanism.loads(limb) {
            if let Load::Custom(load) = load
                && let Some([from, to]) = load.line(&kinematics)
            {
                self.bars
                    .push(Bar::straight(None, from, to, BarKind::Spring));
            }
        }
    }

    fn struts_between_platforms(&mut self, mechanism: &Mechanism, placed: &Placed) {
        for load in mechanism.platform_loads() {
            if let PlatformLoad::Strut(strut) = load {
                let [from, to] = [&strut.from, &strut.to].map(|anchor| match anchor {
                    Anchor::Base(point) => *point,
                    Anchor::Node { node, point } => {
                        let pose = &placed.platforms[*node];
                        pose.translation.vector + pose.rotation * point
                    }
                });
                self.bars
                    .push(Bar::straight(None, from, to, BarKind::Spring));
            }
        }
    }

    fn plates_of(&mut self, mechanism: &Mechanism, placed: &Placed, points: &[Vec<Vector3<f64>>]) {
        for (p, own) in points.iter().enumerate() {
            let base = p == 0;
            if own.len() < 3 || (base && !faces_up(own)) {
                continue;
            }
            let plate = Plate {
                points: own.clone(),
                base,
            };
            if p == mechanism.tool() {
                let middle = own.iter().sum::<Vector3<f64>>() / own.len() as f64;
                let tool = placed.platforms[p].translation.vector;
                self.bars
                    .push(Bar::straight(None, middle, tool, BarKind::Rigid));
            }
            self.plates.push(plate);
        }
    }

    fn grounds_of(&mut self, starts: &[Vector3<f64>]) {
        let Some(middle) = self.middle() else { return };
        let normal = if starts.len() >= 3 && faces_up(starts) {
            Some(Vector3::z())
        } else {
            None
        };
        let near = 1e-6 * self.size;
        for ground in &mut self.grounds {
            // Away from what stands on it, or from the whole machine.
            let mut bars = self.bars.iter().filter(|b| b.length() > 0.0);
            let pedestal = bars.find(|b| (b.ends[0] - ground.at).norm() < near);
            let out = match pedestal {
                Some(bar) if starts.len() == 1 => bar.ends[0] - bar.ends[1],
                _ => ground.at - middle,
            };
            let rail = ground.away;
            ground.away = match normal {
                Some(z) if rail == Vector3::zeros() => z * out.dot(&z).signum(),
                _ => {
                    // Uses the axis that leads out most, square to the rail.
                    let across = out - rail * rail.dot(&out);
                    let mut axis = Vector3::zeros();
                    let most = across.iamax();
                    axis[most] = if across[most] < 0.0 { -1.0 } else { 1.0 };
                    axis
                }
            };
        }
    }

    fn middle(&self) -> Option<Vector3<f64>> {
        let points = self.bars.iter().flat_map(|b| b.ends);
        let (low, high) = corners(points)?;
        Some(0.5 * (low + high))
    }

    /// Names of limbs; of drives where there is one limb.
    fn words_of(&mut self, mechanism: &Mechanism, placed: &Placed) {
        let limbs = mechanism.limbs();
        if limbs.len() == 1 {
            let mut drives = self
                .blobs
                .iter()
                .filter(|b| matches!(b.kind, BlobKind::Motor | BlobKind::Sleeve));
            for actuator in limbs[0].nominal.actuators() {
                if let Some(blob) = drives.next() {
                    self.words.push(Word {
                        at: blob.at,
                        radius: MOTOR,
                        text: actuator.name.clone(),
                    });
                }
            }
        } else if limbs.len() <= MOST_NAMES {
            for (i, limb) in limbs.iter().enumerate() {
                let own = self.bars.iter().filter(|b| b.limb == Some(i));
                let own = own.filter(|b| b.kind != BarKind::Rail);
                if let Some(bar) = own.max_by(|a, b| a.length().total_cmp(&b.length())) {
                    self.words.push(Word {
                        at: 0.55 * bar.ends[0] + 0.45 * bar.ends[1],
                        radius: 3.0,
                        text: limb.name.clone(),
                    });
                }
            }
        }
        let between = 1..mechanism.tool();
        if between.len() <= MOST_NAMES {
            for p in between {
                // A body by the name of its limb is named already.
                let name = &mechanism.platforms()[p].name;
                if self.words.iter().any(|w| w.text == *name) {
                    continue;
                }
                self.words.push(Word {
                    at: placed.platforms[p].translation.vector,
                    radius: 3.0,
                    text: name.clone(),
                });
            }
        }
    }
}

/// Number of limbs at every platform.
fn attachments(mechanism: &Mechanism) -> Vec<usize> {
    let mut count = vec![0; mechanism.platforms().len()];
    for limb in mechanism.limbs() {
        count[limb.from] += 1;
        count[limb.to] += 1;
    }
    count
}

/// True if points span a plane that is rather horizontal.
fn faces_up(points: &[Vector3<f64>]) -> bool {
    let middle = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let mut spread = nalgebra::Matrix3::zeros();
    for p in points {
        spread += (p - middle) * (p - middle).transpose();
    }
    let eigen = spread.symmetric_eigen();
    let (least, middle) = {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        (order[0], order[1])
    };
    let wide = eigen.eigenvalues[middle] > 1e-3 * eigen.eigenvalues.max();
    wide && eigen.eigenvectors.column(least).z.abs() > 0.8
}

/// Lowest and highest coordinates.
pub(super) fn corners(
    points: impl Iterator<Item = Vector3<f64>>,
) -> Option<(Vector3<f64>, Vector3<f64>)> {
    points
        .filter(|p| p.iter().all(|x| x.is_finite()))
        .fold(None, |box_, p| match box_ {
            None => Some((p, p)),
            Some((low, high)) => Some((low.inf(&p), high.sup(&p))),
        })
}
