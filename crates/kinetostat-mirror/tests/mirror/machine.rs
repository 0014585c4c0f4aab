//! Simulated machines: what they do is written down here, not taken from the crate.

use kinetostat_program::{
    CorrectionField, Path, Program, ReadOptions, Unwatched, WriteOptions, interpret,
    write_corrected,
};
use nalgebra::Vector3;

/// Points on the nearest place, without registration.
pub(crate) const SETTINGS: kinetostat_mirror::MeasureSettings =
    kinetostat_mirror::MeasureSettings {
        smoothing_mm: 5.0,
        window_mm: 2.0,
        align: kinetostat_mirror::Alignment::Nearest,
        register: kinetostat_mirror::Register::None,
        scale: false,
    };

pub fn read(text: &str) -> (Program, Path) {
    let program = Program::read(text.to_owned()).expect("a program");
    let path = interpret(&program, &ReadOptions::default()).expect("a path");
    (program, path)
}

/// The path of the program as it is written with a field, to a ten-thousandth of a millimetre.
pub fn commanded(program: &Program, path: &Path, field: &dyn CorrectionField) -> Path {
    commanded_within(program, path, field, (1e-4, 6))
}

/// The same within a tolerance in mm, with so many decimals.
pub fn commanded_within(
    program: &Program,
    path: &Path,
    field: &dyn CorrectionField,
    (tolerance_mm, decimals): (f64, u8),
) -> Path {
    let mut options = WriteOptions::default();
    options.tolerance_mm = tolerance_mm;
    options.decimals = Some(decimals);
    options.header = None;
    let written = write_corrected(program, path, field, &options, &Unwatched).expect("written");
    read(&String::from_utf8(written.bytes).expect("text")).1
}

/// The feed moves of a path as corners with chords between them, and the place at each share of their length.
pub fn sampled(path: &Path, count: usize) -> Vec<Vector3<f64>> {
    let feeds: Vec<_> = path.moves.iter().filter(|m| m.is_known_feed()).collect();
    let whole: f64 = feeds.iter().map(|m| m.length_mm()).sum();
    let at = |way: f64| {
        let mut rest = way;
        for motion in &feeds {
            if rest <= motion.length_mm() {
                return motion.point(rest / motion.length_mm());
            }
            rest -= motion.length_mm();
        }
        feeds.last().expect("a move").end
    };
    (0..count)
        .map(|i| at(whole * (i as f64 + 0.5) / count as f64))
        .collect()
}

/// SplitMix64 and the polar form of Box and Muller.
pub struct Noise(pub u64);

impl Noise {
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    pub fn vector(&mut self, deviation: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| deviation * self.normal())
    }
}

/// A pocket with arcs and a ramp, without a symmetry.
pub const SHAPE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X80 F600\nG3 X90 Y10 J10\nG1 Y40\nG1 X50 Y60 Z8\nG3 X30 Y40 I0 J-20\nG1 X10 Y30 Z2\nM2\n";
