//! What is not made, and why: paths without an orientation, a speed or a place, names and templates that cannot be written.

use kinetostat_formats::*;
use nalgebra::Isometry3;

use super::{cell, gcode};

const LINE: &str = "G21 G90\nG0 X0 Y0 Z0\nG1 X10 F60\n";

fn faults(text: &str, template: &Template, language: MakeLanguage) -> Vec<String> {
    let (_, path) = gcode(text);
    let all = make(&path, &[], template, language).unwrap_err();
    all.iter().map(ToString::to_string).collect()
}

#[test]
fn an_orientation_is_never_guessed() {
    for language in [
        MakeLanguage::Krl,
        MakeLanguage::Rapid,
        MakeLanguage::FanucLs,
    ] {
        let found = faults(LINE, &Template::default(), language);
        assert_eq!(found.len(), 1);
        assert!(
            found[0].starts_with("line 2: the program does not say how the tool stands"),
            "{found:?}"
        );
        assert!(found[0].contains("state tool_orientation in the template"));
    }
    let (_, path) = gcode(LINE);
    assert!(make(&path, &[], &Template::default(), MakeLanguage::Csv).is_ok());
    assert!(make(&path, &[], &Template::default(), MakeLanguage::Apt).is_ok());
}

#[test]
fn a_speed_is_never_guessed() {
    let text = "G21 G90\nG0 X0 Y0 Z0\nG1 X10\nG1 X20\n";
    let found = faults(text, &cell(), MakeLanguage::Krl);
    assert_eq!(found.len(), 2, "all of them, in their order");
    assert!(found[0].starts_with(
        "line 3: the speed of this motion at feed is not known; write an F above zero"
    ));
    let mut template = cell();
    template.unstated_feed_mm_per_s = Some(5.0);
    let (_, path) = gcode(text);
    let made = make(&path, &[], &template, MakeLanguage::Krl).unwrap();
    assert!(super::text_of(&made, 0).contains("$VEL.CP=0.005\n"));
}

#[test]
fn feeds_per_revolution_and_by_time_are_speeds() {
    let (_, path) = gcode("G21 G90\nS1200 M3\nG0 X0 Y0 Z0\nG95 G1 X10 F0.25\nG93 G1 X40 F2\n");
    let made = make(&path, &[], &cell(), MakeLanguage::Krl).unwrap();
    let text = super::text_of(&made, 0);
    assert!(
        text.contains("$VEL.CP=0.005\n") && text.contains("$VEL.CP=0.001\n"),
        "{text}"
    );
}

#[test]
fn a_place_of_the_machine_is_left_out_at_the_ends_alone() {
    let ends = "G21 G90\nG1 Z5 F60\nG0 X0 Y0\nG1 X10\nG53 G0 Z0\nM30\n";
    let (_, path) = gcode(ends);
    let made = make(&path, &[], &cell(), MakeLanguage::Krl).unwrap();
    assert_eq!(made.kept.motions, 2);
    let said: Vec<_> = made
        .findings
        .iter()
        .filter_map(|f| Some((f.line?, f.message.clone())))
        .collect();
    assert_eq!(
        said[0],
        (
            2,
            "where it ends is not known in the part: it is left out, the program begins behind it"
                .into()
        )
    );
    assert_eq!(
        said[1],
        (
            5,
            "it goes to a place of the machine: it is left out".into()
        )
    );
    let between = "G21 G90\nG0 X0 Y0 Z5\nG53 G0 Z0\nG0 X5 Y5 Z5\n";
    let found = faults(between, &cell(), MakeLanguage::Krl);
    assert!(
        found[0].starts_with("line 3: the move goes to a place of the machine"),
        "{found:?}"
    );
    let mut template = cell();
    template.places_unknown = PlacesUnknown::LeftOut;
    let (_, path) = gcode(between);
    assert_eq!(
        make(&path, &[], &template, MakeLanguage::Krl)
            .unwrap()
            .kept
            .motions,
        2
    );
}

#[test]
fn names_too_long_or_strange() {
    let long = "a_name_of_thirty_three_characters";
    for (name, language, words) in [
        (
            long,
            MakeLanguage::Krl,
            "has 33 characters, 24 are allowed here",
        ),
        (
            long,
            MakeLanguage::Rapid,
            "has 33 characters, 32 are allowed here",
        ),
        (
            long,
            MakeLanguage::FanucLs,
            "has 33 characters, 32 are allowed here",
        ),
        (
            "1part",
            MakeLanguage::Krl,
            "controllers take letters, digits and _, a letter first",
        ),
        ("part-2", MakeLanguage::Rapid, "is `part-2`"),
        ("", MakeLanguage::Krl, "a letter first"),
        (
            "a\nb",
            MakeLanguage::Csv,
            "is `ab`, and no file is called so",
        ),
        (
            "a/b",
            MakeLanguage::Gcode,
            "is `a/b`, and no file is called so",
        ),
        (
            "main",
            MakeLanguage::Rapid,
            "a word of its own on controllers",
        ),
    ] {
        let mut template = cell();
        template.program_name = name.into();
        let found = faults(LINE, &template, language);
        assert!(
            found.len() == 1 && found[0].contains(words),
            "{name}: {found:?}"
        );
    }
}

#[test]
fn templates_that_cannot_be_written() {
    type Change = fn(&mut Template);
    let broken: [(MakeLanguage, Change, &str); 27] = [
        (
            MakeLanguage::Krl,
            |t| t.base.pose = Some(Isometry3::translation(1e12, 0.0, 0.0)),
            "pose of the base: position_mm has 1e12",
        ),
        (
            MakeLanguage::Rapid,
            |t| t.tool.frame.pose = Some(Isometry3::translation(0.0, 0.0, -1e30)),
            "pose of the tool: position_mm has -1e30",
        ),
        (
            MakeLanguage::Krl,
            |t| t.rapid_speed_mm_per_s = 0.0,
            "rapid_speed_mm_per_s is 0; 0.001 to 10000 are allowed",
        ),
        (
            MakeLanguage::Krl,
            |t| t.rapid_speed_mm_per_s = f64::NAN,
            "rapid_speed_mm_per_s is NaN",
        ),
        (
            MakeLanguage::Krl,
            |t| t.joint_speed_percent = 101.0,
            "joint_speed_percent is 101; 0.1 to 100",
        ),
        (
            MakeLanguage::Krl,
            |t| t.tolerance_mm = -1.0,
            "tolerance_mm is -1",
        ),
        (
            MakeLanguage::Krl,
            |t| t.unstated_feed_mm_per_s = Some(0.0),
            "unstated_feed_mm_per_s is 0",
        ),
        (
            MakeLanguage::Krl,
            |t| t.acceleration_m_per_s2 = Some(1e9),
            "acceleration_m_per_s2 is 1000000000",
        ),
        (
            MakeLanguage::Krl,
            |t| t.zones.feeds_mm = -0.1,
            "zones: feeds_mm is -0.1",
        ),
        (
            MakeLanguage::Krl,
            |t| t.zones.rapids_mm = f64::INFINITY,
            "zones: rapids_mm is inf",
        ),
        (
            MakeLanguage::FanucLs,
            |t| t.zones.feeds_percent = 120.0,
            "zones: feeds_percent is 120",
        ),
        (
            MakeLanguage::Krl,
            |t| t.position_decimals = 0,
            "position_decimals is 0; 1 to 12",
        ),
        (
            MakeLanguage::Krl,
            |t| t.angle_decimals = 40,
            "angle_decimals is 40",
        ),
        (
            MakeLanguage::Rapid,
            |t| t.quaternion_decimals = 2,
            "quaternion_decimals is 2; 3 to 15",
        ),
        (
            MakeLanguage::Krl,
            |t| t.speed_decimals = Some(13),
            "speed_decimals is 13",
        ),
        (
            MakeLanguage::FanucLs,
            |t| t.most_points = Some(40_000),
            "most_points is 40000; 2 to 32766",
        ),
        (
            MakeLanguage::Krl,
            |t| t.start_joints_deg = Some(vec![0.0; 5]),
            "start_joints_deg has not six values",
        ),
        (
            MakeLanguage::Krl,
            |t| t.configuration = Some("S 2}\nHALT".into()),
            "it is written as \"S 2, T 35\" here",
        ),
        (
            MakeLanguage::Krl,
            |t| t.configuration = Some("S 32, T 35".into()),
            "S from 0 to 31",
        ),
        (
            MakeLanguage::Krl,
            |t| t.configuration = Some("S 2, T 64".into()),
            "T from 0 to 63",
        ),
        (
            MakeLanguage::Krl,
            |t| t.program_name = "If".into(),
            "`If` is a word of its own on controllers",
        ),
        (
            MakeLanguage::Rapid,
            |t| t.program_name = "ENDPROC".into(),
            "`ENDPROC` is a word of its own on controllers",
        ),
        (
            MakeLanguage::Rapid,
            |t| t.configuration = Some("[0,0,0]".into()),
            "it is written as \"[0,-1,0,0]\" here",
        ),
        (
            MakeLanguage::FanucLs,
            |t| t.configuration = Some("N U X, 0, 0, 0".into()),
            "it is written as \"N U T, 0, 0, 0\" here",
        ),
        (
            MakeLanguage::FanucLs,
            |t| t.base.number = Some(62),
            "the number of the base is above 61",
        ),
        (
            MakeLanguage::Krl,
            |t| t.base.name = Some("table".into()),
            "the base has a name, which RAPID alone has",
        ),
        (
            MakeLanguage::Rapid,
            |t| t.tool.mass_kg = Some(0.0),
            "mass_kg of a tool is not from 0.001 to 5000",
        ),
    ];
    for (language, change, words) in broken {
        let mut template = cell();
        change(&mut template);
        let found = faults(LINE, &template, language);
        assert!(
            found.len() == 1 && found[0].contains(words),
            "{words}: {found:?}"
        );
    }
    // All of them in one run.
    let mut template = Template::default();
    template.program_name = "1".into();
    template.tolerance_mm = 0.0;
    template.base.pose = Some(Isometry3::identity());
    assert_eq!(faults(LINE, &template, MakeLanguage::Krl).len(), 3);
}

#[test]
fn g_code_cannot_lean() {
    let text = "MODULE M\nPROC main()\nMoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
        MoveL [[9,0,0],[0,0.9961947,0,0.0871557],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\nENDPROC\nENDMODULE\n";
    let program = read_rapid(
        vec![SourceFile::new("m.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let found = make(&robot.path, &[], &Template::default(), MakeLanguage::Gcode).unwrap_err();
    assert_eq!(found.len(), 1);
    assert!(
        found[0]
            .to_string()
            .starts_with("line 4: the tool's axis is not z of the part here"),
        "{found:?}"
    );
}

/// A word of one language is a name in another.
#[test]
fn main_names_a_program_where_it_is_no_word() {
    let (_, path) = gcode(LINE);
    let mut template = cell();
    template.program_name = "MAIN".into();
    for language in [MakeLanguage::Krl, MakeLanguage::FanucLs] {
        let made = make(&path, &[], &template, language).unwrap();
        let name = made.files[0].0.to_ascii_uppercase();
        assert!(name.starts_with("MAIN."), "{name}");
    }
}

#[test]
fn names_that_a_module_cannot_declare() {
    let refused = |change: &dyn Fn(&mut Template)| {
        let mut template = cell();
        template.tool.frame.pose = Some(Isometry3::translation(1.0, 2.0, 180.0));
        template.base.pose = Some(Isometry3::translation(1.0, 2.0, 3.0));
        change(&mut template);
        faults(LINE, &template, MakeLanguage::Rapid)
    };
    for name in ["MoveL", "main", "IF", "vFeed1", "v100", "fine", "SetDO"] {
        let found = refused(&|template| template.tool.frame.name = Some(name.into()));
        assert!(
            found[0].contains("is a word of RAPID, or a name of the controller"),
            "{name}"
        );
    }
    let found = refused(&|template| {
        template.tool.frame.name = Some("mill".into());
        template.base.name = Some("Mill".into());
    });
    assert!(
        found[0].contains("a tool and the base are both called `Mill`"),
        "{found:?}"
    );
    let found = refused(&|template| {
        template.tool.frame.number = Some(7);
        template.program_name = "tool7".into();
    });
    assert!(
        found[0].contains("the module is called `tool7`"),
        "{found:?}"
    );
}

/// The limit is that of the longest name that is written.
#[test]
fn names_of_parts_count() {
    let (_, path) = gcode("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F60\nG1 X20\nG1 X30\nG1 X40\n");
    for (name, language, several) in [
        (
            "a_name_of_twenty_4_chars",
            MakeLanguage::Krl,
            "24 are allowed",
        ),
        (
            "a_name_of_twenty_4_chars_and_31",
            MakeLanguage::Rapid,
            "32 are allowed",
        ),
        (
            "a_name_of_twenty_4_chars_and_31x",
            MakeLanguage::FanucLs,
            "32 are allowed",
        ),
    ] {
        let mut template = cell();
        template.program_name = name.into();
        make(&path, &[], &template, language).unwrap();
        template.most_points = Some(2);
        let fault = make(&path, &[], &template, language).unwrap_err();
        assert!(fault[0].reason.contains("becomes 3 parts"), "{fault:?}");
        assert!(fault[0].reason.contains(several), "{fault:?}");
    }
    // No controller calls a table by its name.
    let mut template = cell();
    template.program_name = "part-1.2".into();
    for language in [MakeLanguage::Csv, MakeLanguage::Gcode] {
        make(&path, &[], &template, language).unwrap();
    }
}
