//! Made-up runs with realistic figures.

// Each test file uses some of them.
#![allow(dead_code)]

pub mod letters;

use std::f64::consts::TAU;

use kinetostat_machining::{
    ActuatorColumn, PointKind, PointResult, RESULT_SCHEMA, RunResult, Warning, WarningCode,
};
use kinetostat_testing::{largest, least};

fn norm(v: &[f64; 3]) -> f64 {
    v[0].hypot(v[1]).hypot(v[2])
}

/// A number between -1 and 1 that looks random and is always the same.
fn noise(index: usize) -> f64 {
    let x = (index as f64 * 12.9898).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

fn actuator(name: &str, motion_unit: &str, force_unit: &str) -> ActuatorColumn {
    ActuatorColumn {
        name: name.to_owned(),
        motion_unit: motion_unit.to_owned(),
        force_unit: force_unit.to_owned(),
        ..ActuatorColumn::default()
    }
}

/// Fills what follows from the points.
fn summarise(result: &mut RunResult, all_points: usize) {
    let points = result.points.clone();
    let cutting = || points.iter().filter(|p| p.kind != PointKind::Rapid);
    let most = |f: &dyn Fn(&PointResult) -> f64| largest(cutting().map(f));
    let summary = &mut result.summary;
    summary.points = all_points;
    summary.max_position_error_before_mm = most(&|p| norm(&p.error_before_mm));
    summary.rms_position_error_before_mm = 0.8 * summary.max_position_error_before_mm;
    summary.max_position_error_after_mm = most(&|p| norm(&p.error_after_mm));
    summary.rms_position_error_after_mm = 0.5 * summary.max_position_error_after_mm;
    summary.max_correction_mm = most(&|p| norm(&p.correction_mm));
    summary.max_residual_rotation_deg = most(&|p| p.residual_rotation_deg);
    summary.smallest_stiffness_n_per_mm = least(cutting().map(|p| p.smallest_stiffness_n_per_mm));
    let shares: Vec<f64> = cutting().filter_map(|p| p.share_to_buckling).collect();
    summary.largest_share_to_buckling = (!shares.is_empty()).then(|| largest(shares));
    summary.max_actuator_force = (0..result.run_inputs.actuators.len())
        .map(|i| most(&|p| p.actuator_force.get(i).map_or(0.0, |f| f.abs())))
        .collect();
    summary.max_actuator_correction = (0..result.run_inputs.actuators.len())
        .map(|i| most(&|p| p.actuator_correction.get(i).map_or(0.0, |f| f.abs())))
        .collect();
    summary.converged = true;
    summary.stable = true;
    let mut worst: Vec<PointResult> = cutting().cloned().collect();
    worst.sort_by(|a, b| norm(&b.error_before_mm).total_cmp(&norm(&a.error_before_mm)));
    worst.dedup_by_key(|p| p.line);
    worst.truncate(10);
    result.worst_points = worst;
}

/// A circular groove of 25 mm radius on a machine with three prismatic actuators; about 500 points.
pub fn circle_groove() -> RunResult {
    let mut result = {
        let mut result = RunResult::default();
        result.schema = RESULT_SCHEMA;
        result.kinetostat_version = "0.1.0".to_owned();
        result
    };
    let run_inputs = &mut result.run_inputs;
    run_inputs.model = "Orthoglide, three translations".to_owned();
    run_inputs.model_source = "preset orthoglide".to_owned();
    run_inputs.model_deviations = vec![
        "leg x: foot turned by 1 deg about its own axis".to_owned(),
        "leg y: foot turned by 1 deg about its own axis".to_owned(),
        "leg z: foot turned by 1 deg about its own axis".to_owned(),
    ];
    run_inputs.program = "circle-groove.ngc".to_owned();
    run_inputs.load = "milling force turned with the feed: 100 N against it, 40 N across, 60 N up, on cutting moves".to_owned();
    run_inputs.placement = "program origin at X 0, Y 0, Z 0 mm of the machine".to_owned();
    run_inputs.tool = "end mill, 100 mm below the platform".to_owned();
    run_inputs.actuators = ["x", "y", "z"]
        .map(|leg| actuator(&format!("slider {leg}"), "mm", "N"))
        .to_vec();
    run_inputs.tolerance_mm = 0.000_5;
    run_inputs.chord_tolerance_mm = 0.000_2;
    run_inputs.decimals = 4;
    run_inputs.box_min_mm = [-25.0, -25.0, -1.0];
    run_inputs.box_max_mm = [25.0, 25.0, 0.0];
    run_inputs.compensated = true;

    let mut points = Vec::new();
    let rapid = |line, path, position| {
        let mut point = PointResult::default();
        point.line = line;
        point.kind = PointKind::Rapid;
        point.share = 1.0;
        point.path_mm = path;
        point.position_mm = position;
        point.error_before_mm = [0.2, 0.18, 0.21];
        point.stable = true;
        point.actuator_force = vec![0.0; 3];
        point.actuator_correction = vec![0.0; 3];
        point.smallest_stiffness_n_per_mm = 2400.0;
        point.share_to_buckling = Some(0.0);
        point
    };
    points.push(rapid(5, 0.0, [0.0, 0.0, 20.0]));
    points.push(rapid(6, 25.0, [25.0, 0.0, 20.0]));
    points.push(rapid(7, 44.0, [25.0, 0.0, 1.0]));
    let count = 500;
    for i in 0..=count {
        let share = i as f64 / count as f64;
        let angle = TAU * share;
        let plunge = i < 8;
        let (turn, z) = if plunge {
            (0.0, 1.0 - 2.0 * i as f64 / 8.0)
        } else {
            (angle, -1.0)
        };
        let (s, c) = turn.sin_cos();
        let force = [100.0 * s + 40.0 * c, -100.0 * c + 40.0 * s, 60.0];
        let before = [
            0.25 + 0.0031 * force[0] + 0.05 * (2.0 * turn).cos(),
            -0.12 + 0.0028 * force[1],
            0.22 + 0.0011 * force[2] + 0.06 * c,
        ];
        let after = [0, 1, 2].map(|a| 0.000_32 * noise(3 * i + a));
        points.push({
            let mut point = PointResult::default();
            point.line = if plunge {
                8
            } else {
                9 + usize::from(share > 0.5)
            };
            point.output_line = 12 + i;
            point.kind = if i == 8 {
                PointKind::Corner
            } else {
                PointKind::Feed
            };
            point.share = (2.0 * share).fract();
            point.path_mm = 44.0
                + if plunge {
                    2.0 * i as f64 / 8.0
                } else {
                    2.0 + 25.0 * turn
                };
            point.position_mm = [25.0 * c, 25.0 * s, z];
            point.error_before_mm = before;
            point.error_after_mm = after;
            point.correction_mm = before.map(|b| -b);
            point.force_n = force;
            point.residual_rotation_deg = 0.31 + 0.11 * (turn + 0.7).sin();
            point.tool_turn_deg = None;
            point.actuator_force = vec![
                force[0] * 1.1 + 8.0,
                force[1] * 1.1 - 5.0,
                61.0 + 20.0 * (turn * 2.0).cos(),
            ];
            point.actuator_correction = before.map(|b| -b).to_vec();
            point.smallest_stiffness_n_per_mm = 2280.0 + 240.0 * (turn * 3.0).sin() + 90.0 * c;
            point.share_to_buckling = Some(0.11 + 0.06 * (turn + 1.0).cos());
            point.stable = true;
            point
        });
    }
    result.points = points;
    summarise(&mut result, 504);
    let summary = &mut result.summary;
    summary.blocks = 14;
    summary.blocks_out = 468;
    summary.blocks_split = 3;
    summary.blocks_unchanged = 11;
    summary.bytes_in = 412;
    summary.bytes_out = 21_480;
    summary.pieces = 457;
    summary.corner_steps = 2;
    summary.largest_corner_step_mm = 0.31;
    summary.max_corner_error_if_load_turns_mm = Some(0.000_3);
    summary.max_corner_error_if_load_follows_feed_mm = Some(0.000_4);
    summary.smallest_piece_mm = 0.2134;
    summary.blocks_per_second = Some(46.2);
    summary.feed_length_mm = 159.1;
    summary.max_rounding_error_mm = 0.000_087;
    summary.feed_arcs = 1;
    summary.max_speed_deviation_percent = 0.041;
    result.warnings = vec![Warning::new(
        WarningCode::Model,
        "Slider z carries up to 81 N, which is outside the range in which its stiffness was identified (60 N).",
    )];
    result
}

/// A long pocket on a serial robot with six joints; decimated from 80 532 points.
pub fn pocket_on_serial_robot(points: usize) -> RunResult {
    let mut result = circle_groove();
    result.warnings = Vec::new();
    let run_inputs = &mut result.run_inputs;
    run_inputs.model = "Heavy arm with six joints".to_owned();
    run_inputs.model_source = "preset heavy_6r".to_owned();
    run_inputs.model_deviations = Vec::new();
    run_inputs.program = "pocket-roughing.nc".to_owned();
    run_inputs.load =
        "constant force 200, 50, -120 N in base axes, and the weight of the links".to_owned();
    run_inputs.actuators = (1..=6)
        .map(|i| actuator(&format!("joint {i}"), "deg", "N m"))
        .collect();
    result.points = (0..points)
        .map(|i| {
            let row = i / 100;
            let across = (i % 100) as f64 / 99.0;
            let across = if row.is_multiple_of(2) {
                across
            } else {
                1.0 - across
            };
            let rapid = row % 10 == 9 && i % 100 == 99;
            let y = 1.5 * row as f64;
            let x = 180.0 * across;
            let before = [
                0.9 + 0.002 * x,
                0.3 + 0.01 * y + 0.02 * noise(i),
                -0.5 - 0.001 * x,
            ];
            let torque = |k: f64| 900.0 / k - 1.3 * x / k + 40.0 * noise(i + 17) / k;
            {
                let mut point = PointResult::default();
                point.line = 10 + i * 20;
                point.output_line = 20 + i * 21;
                point.kind = if rapid {
                    PointKind::Rapid
                } else {
                    PointKind::Feed
                };
                point.share = 0.5;
                point.path_mm = 1.82 * i as f64 * 20.0;
                point.position_mm = [x, y, -2.0 + 0.02 * y];
                point.error_before_mm = before;
                point.error_after_mm = [0, 1, 2].map(|a| 0.000_28 * noise(3 * i + a));
                point.correction_mm = before.map(|b| -b);
                point.force_n = [200.0, 50.0, -120.0];
                point.residual_rotation_deg = 0.09;
                point.tool_turn_deg = None;
                point.actuator_force = (1..=6).map(|k| torque(f64::from(k * k))).collect();
                point.actuator_correction = (1..=6_u8)
                    .map(|k| 0.05 / f64::from(k) + 0.0001 * x + 0.002 * noise(i + usize::from(k)))
                    .collect();
                point.smallest_stiffness_n_per_mm = 410.0 + 0.2 * x - 0.3 * y + 3.0 * noise(i);
                point.share_to_buckling = None;
                point.stable = true;
                point
            }
        })
        .collect();
    summarise(&mut result, 80_532);
    result.summary.blocks = 40_266;
    result.summary.blocks_out = 41_377;
    result.summary.blocks_split = 1_111;
    result.summary.blocks_unchanged = 39_155;
    result.summary.bytes_in = 1_220_345;
    result.summary.bytes_out = 1_301_002;
    result.summary.pieces = 40_900;
    result
}

/// The groove without compensation.
pub fn analysis() -> RunResult {
    let mut result = circle_groove();
    result.run_inputs.compensated = false;
    for point in result.points.iter_mut().chain(&mut result.worst_points) {
        point.error_after_mm = [0.0; 3];
        point.correction_mm = [0.0; 3];
        point.actuator_correction.clear();
        point.output_line = 0;
    }
    result.warnings.clear();
    result
}

/// The groove with a limb that gives way in one place.
pub fn unstable() -> RunResult {
    let mut result = circle_groove();
    result.summary.stable = false;
    for point in result
        .points
        .iter_mut()
        .filter(|p| (100.0..130.0).contains(&p.path_mm))
    {
        point.stable = false;
        point.share_to_buckling = Some(1.2);
    }
    result.summary.largest_share_to_buckling = Some(1.2);
    result
}

/// Every number is no number or beyond all bounds.
pub fn hostile_numbers() -> RunResult {
    let mut result = circle_groove();
    let bad = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        f64::MIN,
        1e-320,
    ];
    for (i, point) in result
        .points
        .iter_mut()
        .chain(&mut result.worst_points)
        .enumerate()
    {
        let value = bad[i % bad.len()];
        point.error_before_mm = [value, 0.1, value];
        point.error_after_mm = [value; 3];
        point.actuator_force = vec![value; i % 5];
        point.actuator_correction = vec![value; 3];
        point.smallest_stiffness_n_per_mm = value;
        point.share_to_buckling = Some(value);
        point.residual_rotation_deg = value;
        if i % 3 == 0 {
            point.position_mm[i % 2] = value;
            point.path_mm = value;
            point.share = value;
        }
    }
    let s = &mut result.summary;
    for value in [
        &mut s.max_position_error_before_mm,
        &mut s.rms_position_error_before_mm,
        &mut s.max_position_error_after_mm,
        &mut s.rms_position_error_after_mm,
        &mut s.max_rounding_error_mm,
        &mut s.max_correction_mm,
        &mut s.max_residual_rotation_deg,
        &mut s.smallest_stiffness_n_per_mm,
        &mut s.smallest_piece_mm,
        s.blocks_per_second.get_or_insert_default(),
        &mut s.feed_length_mm,
        &mut s.max_speed_deviation_percent,
        &mut s.largest_corner_step_mm,
        &mut result.run_inputs.tolerance_mm,
        &mut result.run_inputs.chord_tolerance_mm,
        &mut result.run_inputs.box_min_mm[0],
        &mut result.run_inputs.box_max_mm[1],
    ] {
        *value = f64::NAN;
    }
    s.largest_share_to_buckling = Some(f64::INFINITY);
    s.max_actuator_force = bad.to_vec();
    result
}

/// Texts that try to become markup, and texts that never end.
pub fn hostile_text() -> RunResult {
    let mut result = circle_groove();
    let evil = "<script>alert(1)</script><img src=x onerror=\"alert(2)\"> '\"&{{ version }} \u{202e}gnp\u{0}";
    let long = "a-very-long-name-without-any-space_".repeat(40);
    let q = &mut result.run_inputs;
    q.model = evil.to_owned();
    q.model_source = format!("{evil}{long}");
    q.model_deviations = vec![evil.to_owned(), long.clone()];
    q.program = long.clone();
    q.load = evil.to_owned();
    q.placement = long.clone();
    q.tool = evil.to_owned();
    for a in &mut q.actuators {
        a.name = evil.to_owned();
        a.force_unit = evil.to_owned();
        a.motion_unit = long.clone();
    }
    result.kinetostat_version = evil.to_owned();
    result.warnings = vec![
        Warning::new(WarningCode::Program, evil),
        Warning::at_line(WarningCode::Writing, 3, long),
    ];
    result
}
