//! The picture of the free turn of a tool.

use kinetostat_machining::{Placement, TurnChoice, TurnTask, choose_turns};
use kinetostat_model::Model;
use kinetostat_program::{Program, ReadOptions, interpret};
use nalgebra::{UnitQuaternion, vector};

/// A line across the front of an arm with a spindle square to its flange.
fn choice(from_deg: f64) -> TurnChoice {
    let square = UnitQuaternion::from_euler_angles(0.0, 0.5 * std::f64::consts::PI, 0.0);
    let tool = kinetostat::Pose::from_parts(vector![0.2, 0.0, 0.1].into(), square);
    let arm = Model::preset("heavy_6r").expect("preset").mechanism;
    let arm = arm.with_tool(&tool);
    let program = Program::read("G21 G90\nG0 X0 Y-400 Z0\nG1 Y400 F600\n").expect("program");
    let path = interpret(&program, &ReadOptions::default()).expect("path");
    let mut placement = Placement::at(vector![1.5, 0.0, 0.9]);
    placement.tool_orientation = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
    let mut task = TurnTask::new(&arm, &path, placement);
    task.station_mm = 20.0;
    task.band.from_deg = from_deg;
    task.band.to_deg = from_deg + 360.0;
    task.bounds.rate_deg_per_mm = 1.0;
    choose_turns(&task).expect("a way")
}

/// Every cell and the line lie inside the frame, and the page is well-formed.
#[test]
fn turns_are_drawn_over_the_path() {
    for from_deg in [-180.0, 0.0, 100.0] {
        let choice = choice(from_deg);
        let svg = kinetostat_report::turns_svg(&choice);
        let document = roxmltree::Document::parse(&svg).expect("well-formed");
        let with_class = |class: &str| {
            let class = class.to_owned();
            document
                .descendants()
                .filter(move |node| node.attribute("class") == Some(&class))
                .count()
        };
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        assert!(with_class("way") == 1 && with_class("ground") == 1);
        assert!(svg.contains("not allowed") && svg.contains("way along the path, mm"));
        // Values are there, in several bands.
        let bands = (0..11).filter(|band| with_class(&format!("f{band}")) > 0);
        assert!(bands.count() >= 3);
        let texts: String = document
            .descendants()
            .filter_map(|node| node.text())
            .collect::<Vec<_>>()
            .join(" ");
        assert!(texts.contains("The tool turns between"), "{texts}");
    }
}
