//! Programs under ridged tables of corrections, written and looked at in random places by code that
//! shares nothing with the crate: its own random numbers, its own arcs, its own interpolation, its own
//! reading of the bytes.

use kinetostat_program::*;
use kinetostat_testing::Worst;
use nalgebra::Vector3;

/// Random numbers from a seed (xorshift64*).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        for _ in 0..8 {
            random.unit();
        }
        random
    }

    /// From 0 to 1, 1 excluded.
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }
}

/// Half the size of the space that programs use, in mm.
const SPACE: f64 = 150.0;

/// A table with its own way of interpolating.
pub struct Table {
    pub axes: [Vec<f64>; 3],
    /// By x, y, z.
    values: Vec<Vector3<f64>>,
}

impl Table {
    fn value(&self, place: [usize; 3]) -> Vector3<f64> {
        let counts = [0, 1, 2].map(|axis| self.axes[axis].len());
        self.values[(place[0] * counts[1] + place[1]) * counts[2] + place[2]]
    }

    /// The sum over the eight corners of the cell.
    pub fn at(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let cell = [0, 1, 2].map(|axis| {
            let nodes = &self.axes[axis];
            if nodes.len() == 1 {
                return (0, 0.0);
            }
            let mut low = 0;
            while low + 2 < nodes.len() && point[axis] > nodes[low + 1] {
                low += 1;
            }
            (
                low,
                (point[axis] - nodes[low]) / (nodes[low + 1] - nodes[low]),
            )
        });
        let mut sum = Vector3::zeros();
        for corner in 0..8_usize {
            let high = [0, 1, 2].map(|axis| corner >> axis & 1);
            if (0..3).any(|axis| high[axis] == 1 && self.axes[axis].len() == 1) {
                continue;
            }
            let weight: f64 = (0..3)
                .map(|axis| {
                    if high[axis] == 1 {
                        cell[axis].1
                    } else {
                        1.0 - cell[axis].1
                    }
                })
                .product();
            sum += self.value([0, 1, 2].map(|axis| cell[axis].0 + high[axis])) * weight;
        }
        sum
    }

    pub fn csv(&self) -> String {
        let mut text = "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n".to_owned();
        for (i, x) in self.axes[0].iter().enumerate() {
            for (j, y) in self.axes[1].iter().enumerate() {
                for (k, z) in self.axes[2].iter().enumerate() {
                    let v = self.value([i, j, k]);
                    text.push_str(&format!("{x},{y},{z},{},{},{}\n", v.x, v.y, v.z));
                }
            }
        }
        text
    }
}

fn axis(random: &mut Random) -> Vec<f64> {
    let (low, high) = (-2.0 * SPACE, 2.0 * SPACE);
    let mut nodes = vec![low, high];
    match random.below(4) {
        // The correction does not vary along this axis.
        0 => return vec![0.0],
        // A ridge one cell wide.
        1 => {
            let place = random.between(-SPACE, SPACE);
            let width = 10_f64.powf(random.between(-3.0, 1.1));
            nodes.extend([place - width, place, place + width]);
        }
        // Even, as a pitch error is measured.
        2 => {
            let count = 3 + random.below(60);
            nodes.extend((1..count).map(|k| low + (high - low) * k as f64 / count as f64));
        }
        _ => nodes.extend((0..1 + random.below(8)).map(|_| random.between(low, high))),
    }
    // Numbers as they stand in a file.
    for node in &mut nodes {
        *node = (*node * 1000.0).round() / 1000.0;
    }
    nodes.sort_by(f64::total_cmp);
    nodes.dedup();
    nodes
}

pub fn table(random: &mut Random) -> Table {
    let mut axes = [axis(random), axis(random), axis(random)];
    if axes.iter().map(Vec::len).product::<usize>() > 4000 {
        axes[2] = vec![0.0];
    }
    let size = 10_f64.powf(random.between(-3.0, -0.3));
    let period = random.between(2.0, 60.0);
    let kind = random.below(3);
    let ridge = [0, 1, 2].map(|axis| axes[axis].len() / 2);
    let mut values = Vec::new();
    for (i, x) in axes[0].iter().enumerate() {
        for (j, y) in axes[1].iter().enumerate() {
            for k in 0..axes[2].len() {
                let along = (std::f64::consts::TAU * (x + 0.3 * y) / period).sin();
                values.push(match kind {
                    0 if [i, j, k] == ridge => Vector3::new(0.2, 1.0, -0.4) * size,
                    0 => Vector3::zeros(),
                    1 => Vector3::new(along, 0.0, 0.1 * along) * size,
                    _ => Vector3::from_fn(|_, _| random.between(-size, size)),
                });
            }
        }
    }
    Table { axes, values }
}

/// A motion as the generator means it.
enum Truth {
    Line([Vector3<f64>; 2]),
    /// About a centre, in a plane (two axes in its order), from an angle by a sweep, rising.
    Arc {
        centre: Vector3<f64>,
        axes: [usize; 3],
        radius: f64,
        start: f64,
        sweep: f64,
        rise: f64,
    },
}

impl Truth {
    fn point(&self, share: f64) -> Vector3<f64> {
        match self {
            Self::Line([from, to]) => from + (to - from) * share,
            Self::Arc {
                centre,
                axes,
                radius,
                start,
                sweep,
                rise,
            } => {
                let angle = start + sweep * share;
                let mut point = *centre;
                point[axes[0]] += radius * angle.cos();
                point[axes[1]] += radius * angle.sin();
                point[axes[2]] += rise * share;
                point
            }
        }
    }
}

/// Lines and full circles, absolute or in increments, with numbers of four decimals.
fn program(random: &mut Random) -> (String, Vec<Truth>) {
    let mut text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 F600\n".to_owned();
    let mut truths = vec![Truth::Line([Vector3::zeros(); 2])];
    let mut place = Vector3::zeros();
    let rounded = |value: f64| (value * 1e4).round() / 1e4;
    for _ in 0..1 + random.below(12) {
        if random.below(4) == 0 {
            // A whole circle ends exactly where it starts, whatever its centre is rounded to.
            let plane = random.below(3);
            let axes = [[0, 1, 2], [2, 0, 1], [1, 2, 0]][plane];
            let radius = 10_f64.powf(random.between(-1.0, 1.8));
            let angle = random.between(0.0, std::f64::consts::TAU);
            let offset = [rounded(radius * angle.cos()), rounded(radius * angle.sin())];
            if offset == [0.0; 2] {
                continue;
            }
            let clockwise = random.below(2) == 0;
            let rise = if random.below(3) == 0 {
                rounded(random.between(-9.0, 9.0))
            } else {
                0.0
            };
            let names = ["X", "Y", "Z"];
            let centres = ["I", "J", "K"];
            text.push_str(&format!(
                "G{} G{} {}{:.4} {}{:.4} {}{:.4}\n",
                17 + plane,
                if clockwise { 2 } else { 3 },
                names[axes[2]],
                place[axes[2]] + rise,
                centres[axes[0]],
                offset[0],
                centres[axes[1]],
                offset[1],
            ));
            let mut centre = place;
            centre[axes[0]] += offset[0];
            centre[axes[1]] += offset[1];
            let turn = std::f64::consts::TAU;
            truths.push(Truth::Arc {
                centre,
                axes,
                radius: offset[0].hypot(offset[1]),
                start: (-offset[1]).atan2(-offset[0]),
                sweep: if clockwise { -turn } else { turn },
                rise,
            });
            place[axes[2]] = rounded(place[axes[2]] + rise);
            continue;
        }
        let far = if random.below(3) == 0 {
            SPACE
        } else {
            10_f64.powf(random.between(-2.0, 1.5))
        };
        let mut to = place;
        for axis in 0..3 {
            if random.below(3) > 0 {
                let reach = if far == SPACE { 0.0 } else { place[axis] };
                to[axis] = rounded((reach + random.between(-far, far)).clamp(-SPACE, SPACE));
            }
        }
        if random.below(6) == 0 {
            let offset = to - place;
            text.push_str(&format!(
                "G91 G1 X{:.4} Y{:.4} Z{:.4}\nG90\n",
                offset.x, offset.y, offset.z
            ));
        } else {
            text.push_str(&format!("G1 X{:.4} Y{:.4} Z{:.4}\n", to.x, to.y, to.z));
        }
        truths.push(Truth::Line([place, to]));
        place = to;
    }
    (text, truths)
}

/// A written motion: where it ends, and the line it stands in.
struct Written {
    to: Vector3<f64>,
    line: usize,
    arc: Option<WrittenArc>,
}

/// A written arc: axes of its plane and normal, its centre in the plane, and the way round.
#[derive(Debug, Clone, Copy)]
pub struct WrittenArc {
    pub axes: [usize; 3],
    pub centre: [f64; 2],
    pub clockwise: bool,
}

impl WrittenArc {
    /// Distance from the centre, and angle.
    fn polar(&self, place: &Vector3<f64>) -> (f64, f64) {
        let out = [
            place[self.axes[0]] - self.centre[0],
            place[self.axes[1]] - self.centre[1],
        ];
        (out[0].hypot(out[1]), out[1].atan2(out[0]))
    }

    /// Radii at its start and end.
    pub fn radii(&self, ends: [Vector3<f64>; 2]) -> [f64; 2] {
        ends.map(|end| self.polar(&end).0)
    }

    /// Angle from start to end; a whole circle ends where it starts.
    pub fn sweep(&self, ends: [Vector3<f64>; 2]) -> f64 {
        let turn = std::f64::consts::TAU;
        let [start, end] = ends.map(|end| self.polar(&end).1);
        let way = match self.clockwise {
            false => end - start,
            true => start - end,
        };
        let way = (way - 1e-9).rem_euclid(turn) + 1e-9;
        if self.clockwise { -way } else { way }
    }

    pub fn length(&self, ends: [Vector3<f64>; 2]) -> f64 {
        let [first, last] = self.radii(ends);
        let rise = ends[1][self.axes[2]] - ends[0][self.axes[2]];
        (0.5 * (first + last) * self.sweep(ends)).hypot(rise)
    }

    /// The place of the arc between two ends that is nearest to another, `part` of the way on or nearly so.
    pub fn beside(&self, ends: [Vector3<f64>; 2], part: f64, place: &Vector3<f64>) -> Vector3<f64> {
        let turn = std::f64::consts::TAU;
        let [first, second, third] = self.axes;
        let [(radius, start), (end_radius, _)] = ends.map(|end| self.polar(&end));
        let sweep = self.sweep(ends);
        let angle = self.polar(place).1 - start;
        let angle = angle + turn * ((sweep * part - angle) / turn).round();
        let at = |share: f64| {
            let share = share.clamp(0.0, 1.0);
            let (angle, radius) = (
                start + sweep * share,
                radius + (end_radius - radius) * share,
            );
            let mut beside = Vector3::zeros();
            beside[first] = self.centre[0] + radius * angle.cos();
            beside[second] = self.centre[1] + radius * angle.sin();
            beside[third] = ends[0][third] + (ends[1][third] - ends[0][third]) * share;
            beside
        };
        // On a steep helix a digit turns it far along its axis: the nearest place is near both.
        let middle = 0.5 * (angle / sweep + part);
        let reach = 0.5 * (angle / sweep - part).abs() + 0.01;
        let [mut low, mut high] =
            [middle - reach, middle + reach].map(|share| share.clamp(0.0, 1.0));
        for _ in 0..60 {
            let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            match (at(a) - place).norm() < (at(b) - place).norm() {
                true => high = b,
                false => low = a,
            }
        }
        at(0.5 * (low + high))
    }
}

/// Reads what these programs can have.
fn read(text: &str) -> Vec<Written> {
    let mut place: Vector3<f64> = Vector3::zeros();
    let (mut incremental, mut mode, mut plane) = (false, 0.0, 17.0);
    let mut list = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.starts_with('(') {
            continue;
        }
        let mut moves = false;
        let from = place;
        let mut centre = place;
        for word in line.split(' ').filter(|word| !word.is_empty()) {
            let (letter, number) = word.split_at(1);
            let value: f64 = number.parse().unwrap_or_else(|_| panic!("{line}"));
            match letter {
                "G" if value == 90.0 => incremental = false,
                "G" if value == 91.0 => incremental = true,
                "G" if value < 4.0 => mode = value,
                "G" if (17.0..20.0).contains(&value) => plane = value,
                "I" | "J" | "K" => {
                    let axis = usize::from(letter.as_bytes()[0] - b'I');
                    centre[axis] = from[axis] + value;
                }
                "X" | "Y" | "Z" => {
                    let axis = usize::from(letter.as_bytes()[0] - b'X');
                    place[axis] = if incremental {
                        place[axis] + value
                    } else {
                        value
                    };
                    moves = true;
                }
                _ => {}
            }
        }
        if moves {
            list.push(Written {
                to: place,
                line: index + 1,
                arc: (mode > 1.0).then(|| {
                    let axes = [[0, 1, 2], [2, 0, 1], [1, 2, 0]][plane as usize - 17];
                    WrittenArc {
                        axes,
                        centre: [centre[axes[0]], centre[axes[1]]],
                        clockwise: mode == 2.0,
                    }
                }),
            });
        }
    }
    list
}

/// What a case came to.
#[derive(Debug, Default, Clone)]
pub struct SampledOutcome {
    pub places: usize,
    pub pieces: usize,
    /// Largest distance as a share of what is allowed.
    pub worst: Worst,
}

/// Writes the program of a seed and looks at it in random places.
///
/// # Errors
///
/// What is wrong, in words.
pub fn check(seed: u64, arcs: Arcs) -> Result<SampledOutcome, String> {
    let mut random = Random::new(seed);
    let table = table(&mut random);
    let (text, truths) = program(&mut random);
    let writing = {
        let mut writing = WriteOptions::default();
        writing.arcs = arcs;
        writing.tolerance_mm = [0.0005, 0.0005, 0.002, 0.02][random.below(4)];
        writing
    };
    let said = |error: &dyn std::fmt::Display| format!("seed {seed}: {error}\n{text}");
    let map = CorrectionMap::read(table.csv().as_bytes()).map_err(|e| said(&e))?;
    let input = Program::read(text.as_bytes()).map_err(|e| said(&e))?;
    let reading = {
        let mut reading = ReadOptions::default();
        reading.start_position_mm = Some(Vector3::zeros());
        reading
    };
    let path = interpret(&input, &reading).map_err(|e| said(&e))?;
    let written =
        write_corrected(&input, &path, &map, &writing, &Unwatched).map_err(|e| said(&e))?;
    verify_written(&input, &path, &written, &reading, &writing).map_err(|e| said(&e))?;
    let against =
        verify_against_field(&path, &written, &map, &writing, &Unwatched).map_err(|e| said(&e))?;
    let output = String::from_utf8(written.bytes.clone()).map_err(|e| said(&e))?;
    let reached = read(&output);
    if reached.len() != written.pieces.len() {
        return Err(said(&format!(
            "{} motions read, {} written",
            reached.len(),
            written.pieces.len()
        )));
    }
    if truths.len() != path.moves.len() {
        return Err(said(
            &"the generator and the reader count motions differently",
        ));
    }
    let mut found = SampledOutcome {
        pieces: reached.len(),
        ..SampledOutcome::default()
    };
    let mut from = Vector3::zeros();
    for (motion, piece) in reached.iter().zip(&written.pieces) {
        if motion.line != piece.output_line {
            return Err(said(&format!(
                "a motion of line {} appears in line {}",
                piece.output_line, motion.line
            )));
        }
        let truth = &truths[piece.move_index];
        // The tolerance with the tenth that may be unknown, the chord of an arc, three roundings.
        let rounding = 3.0_f64.sqrt() * 0.5e-4;
        let mut allowed = 1.1 * writing.tolerance_mm + rounding + 1e-6;
        if matches!(truth, Truth::Arc { .. }) {
            allowed += 1.2 * writing.chord_tolerance_mm;
        }
        let length =
            path.moves[piece.move_index].length_between_mm(piece.share_from, piece.share_to);
        let count = if piece.move_index == 0 {
            0
        } else {
            3 + (length / 4.0) as usize
        };
        for _ in 0..count {
            let part = random.unit();
            let share = piece.share_from + (piece.share_to - piece.share_from) * part;
            let there = truth.point(share);
            let wanted = there + table.at(&there);
            let commanded = match &motion.arc {
                Some(arc) => arc.beside([from, motion.to], part, &wanted),
                None => from + (motion.to - from) * part,
            };
            let off = (commanded - wanted).norm();
            found.places += 1;
            if off.is_nan() || off > allowed {
                return Err(said(&format!(
                    "output line {}: {off} mm off at {share} of move {}, {allowed} allowed; the crate's own check \
                     found {} mm at most",
                    motion.line, piece.move_index, against.after.distance_mm
                )));
            }
            found.worst.add(off / allowed);
        }
        from = motion.to;
    }
    Ok(found)
}
