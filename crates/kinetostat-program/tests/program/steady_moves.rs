//! Short blocks along which nothing but the place changes: their ends say all.

use kinetostat_program::*;
use nalgebra::Vector3;
use std::sync::Mutex;

use super::writing::{at_origin, bare, written_with};

/// A correction that changes with the place, a step of so many mm beyond `x = 5.005` with it; where it is asked for is noted.
struct Noted {
    is_steady: bool,
    step_mm: f64,
    shares: Mutex<Vec<f64>>,
}

impl Noted {
    fn new(is_steady: bool, step_mm: f64) -> Self {
        let shares = Mutex::default();
        Self {
            is_steady,
            step_mm,
            shares,
        }
    }
}

impl CorrectionField for Noted {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let mut shares = self.shares.lock().unwrap();
        shares.extend(requests.iter().map(|request| request.share));
        let at = |request: &Request| {
            let [x, y] = [request.position_mm.x, request.position_mm.y];
            let step = if x > 5.005 { self.step_mm } else { 0.0 };
            let (u, v) = (0.01 * x, 0.01 * y);
            Ok(Correction::from(Vector3::new(
                0.3 + 0.1 * u * v,
                0.05 * u.sin() + step,
                0.2 * v.cos(),
            )))
        };
        requests.iter().map(at).collect()
    }

    fn structure(&self, _move_index: usize, _motion: &Move) -> Structure {
        let radius_mm = 100.0;
        Structure {
            breaks: Vec::new(),
            course: match self.is_steady {
                true => Course::Steady { radius_mm },
                false => Course::Smooth { radius_mm },
            },
        }
    }
}

/// Blocks of 0.03 mm, and one that is long.
fn program() -> String {
    let mut text = String::from("G21 G90\nG1 F500 X0 Y0 Z0\n");
    for i in 1..=400 {
        let x = 0.03 * f64::from(i);
        text.push_str(&format!("G1 X{x:.4} Y{:.4}\n", 0.1 * x.sin()));
    }
    text.push_str("G1 X60\n");
    text
}

#[test]
fn short_steady_blocks_are_asked_for_at_their_ends_only() {
    let program = program();
    let text = |field: &Noted| written_with(&program, field, &at_origin(), &bare()).0;
    let (steady, smooth) = (Noted::new(true, 0.0), Noted::new(false, 0.0));
    assert_eq!(text(&steady), text(&smooth));
    let middles = |field: &Noted| {
        let shares = field.shares.lock().unwrap();
        shares.iter().filter(|share| **share == 0.5).count()
    };
    // Of the long block alone.
    assert_eq!(middles(&steady), 1);
    assert!(middles(&smooth) >= 400);
}

#[test]
fn where_ends_of_a_steady_block_differ_more_than_the_tolerance_its_middle_is_asked_for() {
    let program = program();
    let text = |field: &Noted| written_with(&program, field, &at_origin(), &bare()).0;
    let (steady, smooth) = (Noted::new(true, 0.1), Noted::new(false, 0.1));
    let found = text(&steady);
    assert_eq!(found, text(&smooth));
    assert_ne!(found, text(&Noted::new(true, 0.0)));
    let shares = steady.shares.lock().unwrap();
    assert!(shares.iter().filter(|share| **share == 0.5).count() >= 2);
}
