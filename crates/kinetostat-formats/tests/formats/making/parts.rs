//! Long programs: a main program and numbered parts.

use kinetostat_formats::*;
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use super::{ROBOTS, cell, gcode, read_made, text_of};

#[test]
fn parts_go_on_where_the_part_before_ended() {
    let mut text = String::from("G21 G90\nG0 X0 Y0 Z0\n");
    for index in 0..50 {
        let x = f64::from(index) * 10.0;
        text += &format!("G1 X{} Y0 F600\nG3 X{} Y0 I2.5 J0\n", x + 5.0, x + 10.0);
    }
    let (_, path) = gcode(&text);
    let mut template = cell();
    template.most_points = Some(20);
    template.program_name = "long".into();
    for (into, language) in ROBOTS {
        let made = make(&path, &[], &template, into).unwrap();
        // 151 places, an arc has two.
        assert_eq!(
            made.files.len(),
            9,
            "{:?}",
            made.files.iter().map(|f| &f.0).collect::<Vec<_>>()
        );
        let ending = into.ending();
        assert_eq!(made.files[0].0, format!("long.{ending}"));
        assert_eq!(made.files[8].0, format!("long_8.{ending}"));
        let main = text_of(&made, 0);
        let calls = main.matches("long_").count() + main.matches("LONG_").count();
        assert_eq!(calls, 8, "{main}");
        let program = read_made(&made, language);
        assert_eq!(program.motions.len(), 101);
        let mut worst = Worst::default();
        for (index, (motion, wanted)) in program.motions.iter().zip(&path.moves).enumerate() {
            assert_eq!(motion.follows, index.checked_sub(1));
            worst.add((motion.target.pose().unwrap().position_mm - wanted.end).norm());
        }
        assert!(worst.value() < 1e-6);
        // Lines of the motions, counted through the files.
        assert_eq!(made.lines.len(), program.motions.len());
        let mut through = made.files.iter().flat_map(|(_, bytes)| {
            let text = String::from_utf8(bytes.clone()).unwrap();
            text.lines().map(str::to_owned).collect::<Vec<_>>()
        });
        let mut at = 0;
        for ([line, source], wanted) in made.lines.iter().zip(&path.moves) {
            assert_eq!(*source, wanted.line);
            let text = through.nth(line - at - 1).unwrap();
            at = *line;
            let words = ["LIN", "CIRC", "PTP", "Move", "L P[", "C P[", "J P["];
            assert!(
                words.iter().any(|word| text.contains(word)),
                "{line}: {text}"
            );
        }
        let file = text_of(&made, 3);
        let places =
            file.matches("{X ").count() + file.matches("[[").count() + file.matches("\nP[").count();
        assert!(places <= 21, "{file}"); // with the one of a frame
    }
}

#[test]
fn tools_of_several_are_taken_in_their_parts() {
    let text = "G21 G90\nT1 M6\nG0 X0 Y0 Z0\nG1 X5 F60\nT2 M6\nG0 X0\nG1 X5\nG1 X6\n";
    let (program, path) = gcode(text);
    let events = events_of_gcode(&program, &path);
    let mut template = cell();
    let refused = make(&path, &events, &template, MakeLanguage::Krl).unwrap_err();
    assert_eq!(refused[0].line, Some(2));
    assert!(
        refused[1]
            .to_string()
            .contains("line 5: the program takes the tool 2, one of several"),
        "{refused:?}"
    );
    for number in [1, 2] {
        let mut tool = StatedTool::default();
        tool.frame.number = Some(number);
        tool.frame.pose = Some(nalgebra::Isometry3::translation(
            0.0,
            0.0,
            100.0 * f64::from(number),
        ));
        template.tools.insert(number, tool);
    }
    template.most_points = Some(4);
    for (into, language) in ROBOTS {
        let made = make(&path, &events, &template, into).unwrap();
        let program = read_made(&made, language);
        assert_eq!(program.motions.len(), 5);
        for (index, motion) in program.motions.iter().enumerate() {
            let length = match index {
                0 | 1 => 100.0,
                _ => 200.0,
            };
            match into {
                MakeLanguage::FanucLs => {
                    assert_eq!(motion.tool.name, format!("UT:{}", length / 100.0))
                }
                _ => assert_eq!(
                    motion.tool.known().unwrap().translation.vector,
                    Vector3::z() * length
                ),
            }
        }
    }
}

/// Places that follow one another faster than an arm's controller plans are named; single ones, and those of other machines, are not.
#[test]
fn crowded_places_are_named() {
    let dense = |count: usize| {
        let mut text = "G21 G90\nG0 X0 Y0 Z0\nG1 X0.05 F6000\n".to_owned();
        for index in 2..=count {
            text.push_str(&format!("X{:.3}\n", 0.05 * index as f64));
        }
        text
    };
    let said = |text: &str, language: MakeLanguage| {
        let (_, path) = gcode(text);
        let made = make(&path, &[], &cell(), language).unwrap();
        let all = made.findings.iter();
        let found = all.filter(|finding| finding.message.contains("may slow down"));
        found.cloned().collect::<Vec<_>>()
    };
    for language in [
        MakeLanguage::Krl,
        MakeLanguage::Rapid,
        MakeLanguage::FanucLs,
    ] {
        let found = said(&dense(40), language);
        assert_eq!(found.len(), 1);
        // 0.05 mm at 100 mm/s: 0.5 ms; the 16th of them is on line 18.
        assert_eq!(found[0].line, Some(18));
        let message = &found[0].message;
        assert!(
            message.starts_with("40 motions are shorter than 8 ms"),
            "{message}"
        );
        assert!(message.contains("0.050 mm, up to 2000"), "{message}");
        assert!(said(&dense(15), language).is_empty());
        let slow = dense(40).replace("F6000", "F300");
        assert!(said(&slow, language).is_empty());
    }
    assert!(said(&dense(40), MakeLanguage::Csv).is_empty());
}
