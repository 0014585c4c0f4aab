//! An independent sampler over programs corrected by ridged tables, and the two tables that came back
//! without a correction once.

// Helpers of tests, which clippy does not count as tests.
use kinetostat_program::*;
use kinetostat_testing::{Worst, least};
use nalgebra::Vector3;

/// 300, or as many as `KINETOSTAT_CASES` says.
fn cases() -> u64 {
    let setting = std::env::var("KINETOSTAT_CASES").ok();
    setting.and_then(|cases| cases.parse().ok()).unwrap_or(300)
}

#[test]
fn written_programs_are_within_their_bound_in_random_places() {
    let (mut places, mut pieces, mut worst) = (0, 0, Worst::new());
    let cases = cases();
    for (seed, arcs) in (1..=cases).flat_map(|seed| [(seed, Arcs::Fit), (seed, Arcs::Lines)]) {
        let found = crate::sampled::check(seed, arcs).unwrap_or_else(|what| panic!("{what}"));
        places += found.places;
        pieces += found.pieces;
        worst.add(found.worst.of_all(found.places));
    }
    let worst = worst.of(2 * cases as usize);
    println!(
        "{cases} programs in two ways, {pieces} motions, {places} places, worst {worst:.3} of what is allowed"
    );
    assert!(places as u64 > 20 * cases);
    // A bound that nothing comes near would be no bound.
    assert!((0.5..=1.0).contains(&worst), "{worst}");
}

fn corrected(table: &str, text: &str) -> (String, Corrected, FieldCheck) {
    let map = CorrectionMap::read(table.as_bytes()).unwrap();
    let program = Program::read(text).unwrap();
    let reading = ReadOptions::default();
    let path = interpret(&program, &reading).unwrap();
    let writing = {
        let mut writing = WriteOptions::default();
        writing.header = None;
        writing
    };
    let written = write_corrected(&program, &path, &map, &writing, &Unwatched).unwrap();
    verify_written(&program, &path, &written, &reading, &writing).unwrap();
    let against = verify_against_field(&path, &written, &map, &writing, &Unwatched).unwrap();
    let output = String::from_utf8(written.bytes.clone()).unwrap();
    (output, written, against)
}

const HEAD: &str = "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n";
const LINE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X300 F600\nM2\n";

#[test]
fn a_ridge_of_one_cell_is_followed() {
    let mut table = HEAD.to_owned();
    for (x, dy) in [
        (-10.0, 0.0),
        (100.0, 0.0),
        (110.0, 0.3),
        (120.0, 0.0),
        (310.0, 0.0),
    ] {
        table.push_str(&format!("{x},0,0,0,{dy},0\n"));
    }
    let (output, ..) = corrected(&table, LINE);
    assert_eq!(
        output,
        "G21 G90\nG0 X0 Y0 Z0\nG1 X100.0000 F600\nX110.0000 Y0.3000\nX120.0000 Y0.0000\nX300.0000\nM2\n"
            .replace("\nX", "\nG1 X")
    );
}

#[test]
fn a_pitch_error_is_followed_under_round_coordinates() {
    let mut table = HEAD.to_owned();
    for k in 0..=256 {
        let x = -10.0 + 1.25 * f64::from(k);
        let dx = 0.02 * (std::f64::consts::TAU * x / 5.0).sin();
        table.push_str(&format!("{x},0,0,{dx},0,0\n"));
    }
    let (_, written, against) = corrected(&table, LINE);
    // Two straight stretches in each of sixty periods.
    assert!(written.pieces.len() >= 120, "{}", written.pieces.len());
    assert!((written.accounting.largest_correction_mm - 0.02).abs() < 1e-12);
    assert!(
        against.after.distance_mm < 1e-3 && against.places > 480,
        "{against:?}"
    );
}

/// What an older division wrote: nothing was seen of the ridge, and nothing by the check of the text.
#[test]
fn the_check_against_the_table_finds_what_a_division_overlooked() {
    let flat = CorrectionMap::read(format!("{HEAD}0,0,0,0,0,0\n").as_bytes()).unwrap();
    let mut table = HEAD.to_owned();
    for (x, dy) in [
        (-10.0, 0.0),
        (100.0, 0.0),
        (110.0, 0.3),
        (120.0, 0.0),
        (310.0, 0.0),
    ] {
        table.push_str(&format!("{x},0,0,0,{dy},0\n"));
    }
    let ridged = CorrectionMap::read(table.as_bytes()).unwrap();
    let program = Program::read(LINE).unwrap();
    let path = interpret(&program, &ReadOptions::default()).unwrap();
    let writing = WriteOptions::default();
    let written = write_corrected(&program, &path, &flat, &writing, &Unwatched).unwrap();
    let error = verify_against_field(&path, &written, &ridged, &writing, &Unwatched).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("from where the corrections want it"),
        "{error}"
    );
}

#[test]
fn a_move_passes_planes_where_its_points_say_so() {
    let text = "G21 G90 G17\nG0 X0 Y0 Z0\nG1 X30 Y-7 Z2 F100\nG2 X30 Y-7 Z9 I-5 J3\nG3 X20 Y-7 I-5\nG18 G2 X25 Z12 R14\n";
    let program = Program::read(text).unwrap();
    let path = interpret(&program, &ReadOptions::default()).unwrap();
    let planes: Vec<f64> = (-40..80).map(|k| 0.5 * f64::from(k) + 0.123).collect();
    let mut crossed = 0;
    for motion in &path.moves {
        for axis in 0..3 {
            let mut shares = motion.shares_at(axis, &planes);
            shares.sort_by(f64::total_cmp);
            for share in &shares {
                let place = motion.point(*share)[axis];
                let nearest = least(planes.iter().map(|p| (p - place).abs()));
                assert!(nearest < 1e-9, "line {} axis {axis}", motion.line);
            }
            // As many as fine steps along the move counts.
            let side = |share: f64| planes.partition_point(|p| *p < motion.point(share)[axis]);
            let counted: usize = (0..20_000)
                .map(|k| (f64::from(k) / 20_000.0, f64::from(k + 1) / 20_000.0))
                .map(|(a, b)| side(a).abs_diff(side(b)))
                .sum();
            assert_eq!(shares.len(), counted, "line {} axis {axis}", motion.line);
            crossed += counted;
        }
    }
    assert!(crossed > 150, "{crossed}");
}

/// A closure of which nothing is known, with a wave of 40 mm: evaluated often enough.
#[test]
fn a_wave_that_is_zero_in_every_round_place_is_seen() {
    let field = |request: &Request| {
        let x = request.position_mm.x;
        Ok(Vector3::new(
            0.0,
            0.05 * (std::f64::consts::TAU * x / 75.0).sin(),
            0.0,
        ))
    };
    let program = Program::read(LINE).unwrap();
    let path = interpret(&program, &ReadOptions::default()).unwrap();
    let writing = WriteOptions::default();
    let written = write_corrected(&program, &path, &field, &writing, &Unwatched).unwrap();
    assert!(written.pieces.len() > 50, "{}", written.pieces.len());
    verify_against_field(&path, &written, &field, &writing, &Unwatched).unwrap();
}
