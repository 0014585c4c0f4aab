//! A mirrored program, and a mirrored one on top of a model.

use kinetostat_mirror::{MeasureSettings, MirrorField, MirrorState, NominalPath, SumOfFields};
use kinetostat_program::{CorrectionField, FieldFailure, Request};
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use crate::machine::{commanded, read};

const PASSES: &str = "G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F600\nG1 X60\nG1 X60\nG1 Y30\nG0 Z5\nG0 X0 Y30\nG0 Z0\nG1 X30\nG0 Z9\nM2\n";

fn wave(along: f64) -> Vector3<f64> {
    Vector3::new(
        0.01 * (along / 40.0).sin(),
        0.02 * (along / 30.0).cos(),
        0.03,
    )
}

fn state(nominal: &NominalPath<'_>) -> MirrorState {
    let settings = MeasureSettings::default();
    let mut state = MirrorState::new(nominal, "passes", settings).expect("a state");
    for (correction, along) in state.correction_mm.iter_mut().zip(&state.along_mm) {
        *correction = wave(*along);
    }
    state
}

fn request(path: &kinetostat_program::Path, move_index: usize, share: f64) -> Request {
    let motion = &path.moves[move_index];
    Request {
        move_index,
        share,
        position_mm: motion.point(share),
        tangent: motion.tangent(share),
        orientation: None,
        turning: None,
    }
}

#[test]
fn corrections_go_on_without_a_step_from_move_to_move() {
    let (_, path) = read(PASSES);
    let nominal = NominalPath::new(&path).unwrap();
    let state = state(&nominal);
    let field = MirrorField::new(&nominal, &state).unwrap();
    let at = |index: usize, share: f64| {
        let found = field.corrections(&[request(&path, index, share)]);
        found[0].clone().unwrap().shift_mm
    };
    let mut worst = Worst::new();
    for index in 1..path.moves.len() {
        worst.add((at(index, 0.0) - at(index - 1, 1.0)).norm());
    }
    assert!(worst.of(path.moves.len() - 1) < 1e-12, "{worst}");
    // Within a pass the cubic curves are those of the wave: stations 1.25 mm apart.
    let mut worst = Worst::new();
    for piece in nominal.pieces() {
        for k in 0..=50 {
            let share = f64::from(k) / 50.0;
            let along = piece.from_mm + share * piece.length_mm;
            worst.add((at(piece.move_index, share) - wave(along)).norm());
        }
    }
    assert!(worst.value() < 5e-6, "{worst}");
}

#[test]
fn a_mirror_is_added_to_a_model() {
    let (program, path) = read(PASSES);
    let nominal = NominalPath::new(&path).unwrap();
    let state = state(&nominal);
    let mirror = MirrorField::new(&nominal, &state).unwrap();
    let model = |request: &Request| -> Result<Vector3<f64>, FieldFailure> {
        Ok(Vector3::new(0.0, 1e-3 * request.position_mm.x, 0.0))
    };
    let both = SumOfFields {
        model: &model,
        mirror: &mirror,
    };
    let written = commanded(&program, &path, &both);
    // The end of the first pass, 65 mm of straight moves and 30 mm.
    let expected = Vector3::new(60.0, 30.0, 0.0) + wave(95.0) + Vector3::new(0.0, 0.06, 0.0);
    let found = written.moves.iter().map(|m| (m.end - expected).norm());
    let nearest = found.min_by(f64::total_cmp).unwrap();
    assert!(nearest < 2e-6, "{nearest}");
}

#[test]
fn a_state_of_another_path_is_no_field() {
    let (_, path) = read(PASSES);
    let (_, other) = read("G21 G90\nG0 X0 Y0 Z0\nG1 X400 F600\n");
    let nominal = NominalPath::new(&path).unwrap();
    let state = state(&nominal);
    let other = NominalPath::new(&other).unwrap();
    assert!(MirrorField::new(&other, &state).is_err());
}
