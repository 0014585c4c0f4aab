//! Rotary axes across 0 and 360 deg: on an axis that counts on, on one that shows 0 to 360, and where a program does not say which.

use kinetostat_formats::Language;

use crate::axis_angles::{corrected, feeds, heidenhain, read_as, robot, siemens};
use crate::chance::Chance;

/// Where the axis C begins and ends in the cuts, deg.
fn turns_of_c(language: Language, text: &str) -> Vec<[f64; 2]> {
    let robot = robot(language, text);
    let cuts = feeds(&robot.path);
    let turns = cuts.iter().map(|cut| {
        let rotary = cut.tool_turn.as_ref().unwrap().rotary.as_ref().unwrap();
        [rotary.start_deg[1], rotary.end_deg[1]]
    });
    turns.collect()
}

fn assert_turns(language: Language, text: &str, expected: &[[f64; 2]]) {
    let found = turns_of_c(language, text);
    assert_eq!(found.len(), expected.len(), "{text}");
    for (found, expected) in found.iter().zip(expected) {
        for end in 0..2 {
            let off = (found[end] - expected[end]).abs();
            assert!(off < 1e-9, "{found:?} {expected:?}\n{text}");
        }
    }
}

#[test]
fn an_axis_of_one_turn_counts_from_the_angle_that_it_shows() {
    let cases = [
        // From 10, which is 370 all in all.
        (
            "G0 C350\nG1 X5 C=IC(20) F600\nX9 C20\nX12 C=DC(30)\nX20 C40\n",
            vec![
                [350.0, 370.0],
                [370.0, 380.0],
                [380.0, 390.0],
                [390.0, 400.0],
            ],
        ),
        (
            "G0 C350\nG1 X5 C=ACP(10) F600\nX9 C=IC(-30)\nX12 C20\nX20 C340\n",
            vec![[350.0, 370.0], [370.0, 340.0], [340.0, 20.0], [20.0, 340.0]],
        ),
        // On an arc behind a step.
        (
            "G0 X0 Y0 C=ACN(300)\nG1 Z0 C=IC(90) F600\nG3 X40 Y40 I0 J40 C120\n",
            vec![[-60.0, 30.0], [30.0, 120.0]],
        ),
        // The words that say it stand behind; three thirds of a turn are none.
        (
            "G1 X5 C=IC(120) F600\nG91 X9 C120\nX1 C120\nG90 X7 C0\nX3 C=ACN(350)\nX4 C355\n",
            vec![
                [0.0, 120.0],
                [120.0, 240.0],
                [240.0, 360.0],
                [360.0, 360.0],
                [360.0, 350.0],
                [350.0, 355.0],
            ],
        ),
    ];
    for (body, expected) in cases {
        assert_turns(Language::Siemens, &siemens(body), &expected);
    }
}

#[test]
fn words_beyond_one_turn_are_refused_where_it_counts_from_0_to_360() {
    for (body, line, words) in [
        ("G1 X5 C370 F600\nX9 C=DC(30)\n", 5, "C=IC(10)"),
        (
            "G0 C=DC(30)\nG1 X5 C-20 F600\n",
            6,
            "axis C is sent to -20 deg",
        ),
        (
            "G0 C=DC(30)\nG1 X5 C=AC(360) F600\n",
            6,
            "from 0 to 359.999",
        ),
    ] {
        let errors = read_as(Language::Siemens, &siemens(body)).unwrap_err();
        let said = errors[0].to_string();
        assert!(said.contains(words) && errors.len() == 1, "{said}");
        assert_eq!(errors[0].line, line, "{said}");
    }
}

#[test]
fn where_it_is_open_how_the_axis_counts_a_cut_across_360_is_refused() {
    let cases = [
        (
            Language::Siemens,
            siemens("G0 C350\nG1 X5 C=IC(20) F600\nX9 C20\nX20 C40\n"),
            "it came to 370 deg by a step or the shorter way. If it counts on it turns by -350 deg, and if it counts from 0 to 360, it stands at 10 and turns by 10 deg",
            "C=IC(-350) or C=IC(10); or, on an axis that counts from 0 to 360, C=DC(20)",
        ),
        (
            Language::Siemens,
            siemens("G0 C20\nG1 G91 X5 C-50 F600\nG90 X9 C45\n"),
            "it came to -30 deg by a step or the shorter way. If it counts on it turns by 75 deg, and if it counts from 0 to 360, it stands at 330 and turns by -285 deg",
            "state C-30 where it stands",
        ),
        (
            Language::Heidenhain,
            heidenhain("L C+350 FMAX\nL X+5 IC+20 F600\nL X+9 C+20\nL X+20 C+40\n"),
            "If it counts on it turns by -350 deg, and if it counts from 0 to 360, it stands at 10 and turns by 10 deg",
            "IC-350 or IC+10; or, on an axis that counts from 0 to 360, M126 in the block",
        ),
        (
            Language::Heidenhain,
            heidenhain("L C+350 FMAX\nL X+5 C+10 F600 M126\nL X+6 M127\nL X+20 C+40\n"),
            "If it counts on it turns by -330 deg, and if it counts from 0 to 360, it stands at 10 and turns by 30 deg",
            "M126 in the block",
        ),
    ];
    for (language, text, reason, remedy) in cases {
        let errors = read_as(language, &text).unwrap_err();
        let said = errors[0].to_string();
        assert!(said.contains(reason) && said.contains(remedy), "{said}");
        let line = match text.contains("M127") {
            true => 8,
            false => 7,
        };
        assert_eq!((errors.len(), errors[0].line), (1, line), "{said}");
    }
}

#[test]
fn remedies_and_rapids_are_followed() {
    let on = [[350.0, 370.0], [370.0, 20.0], [20.0, 40.0]];
    let within = [[350.0, 370.0], [370.0, 380.0], [380.0, 400.0]];
    for (language, text, expected) in [
        // By a step, and where the program says that the axis counts on, before or behind.
        (
            Language::Siemens,
            siemens("G0 C350\nG1 X5 C=IC(20) F600\nX9 C=IC(-350)\nX20 C40\n"),
            &on[..],
        ),
        (
            Language::Siemens,
            siemens("G0 C350\nG1 X5 C=IC(20) F600\nX9 C20\nX20 C40\nG0 C-90\n"),
            &on[..],
        ),
        (
            Language::Heidenhain,
            heidenhain("L C-1 FMAX\nL C+350 FMAX\nL X+5 IC+20 F600\nL X+9 C+20\nL X+20 C+40\n"),
            &on[..],
        ),
        (
            Language::Siemens,
            siemens("G0 C350\nG1 X5 C=IC(20) F600\nX9 C=DC(20)\nX20 C40\n"),
            &within[..],
        ),
        (
            Language::Heidenhain,
            heidenhain("L C+350 FMAX\nL X+5 IC+20 F600\nL X+9 C+20 M126\nL X+20 C+40\nM127\n"),
            &within[..],
        ),
        // A rapid comes to the same place of the part both ways; what is cut behind it is the same, too.
        (
            Language::Heidenhain,
            heidenhain("L C+350 FMAX\nL X+5 IC+20 F600\nL X+9 C+20 FMAX\nL X+20 C+40\n"),
            &[[350.0, 370.0], [20.0, 40.0]],
        ),
    ] {
        assert_turns(language, &text, expected);
    }
}

/// Turns of C by the words of a text on an axis that shows 0 to 360 deg, and of one that counts on; by hand.
fn turns_by_hand(text: &str) -> Vec<[f64; 2]> {
    let (mut shown, mut counted, mut shorter) = (0.0, 0.0, false);
    let mut turns = Vec::new();
    let nearest = |turn: f64| (turn + 180.0).rem_euclid(360.0) - 180.0;
    for line in text.lines() {
        let value = |word: &str| -> f64 { word.trim_end_matches(')').parse().unwrap() };
        shorter |= line.contains("M126");
        let mut own = None;
        for word in line.split_whitespace() {
            let absolute = |to: f64| {
                assert!((0.0..360.0).contains(&to), "{line}");
                to
            };
            own = if let Some(by) = word.strip_prefix("C=IC(").or(word.strip_prefix("IC")) {
                Some([value(by); 2])
            } else if let Some(to) = word.strip_prefix("C=ACP(") {
                Some([(absolute(value(to)) - shown).rem_euclid(360.0); 2])
            } else if let Some(to) = word.strip_prefix("C=DC(") {
                Some([nearest(absolute(value(to)) - shown); 2])
            } else if let Some(to) = word.strip_prefix('C').filter(|to| value_like(to)) {
                let to = absolute(value(to));
                Some(match shorter {
                    true => [nearest(to - shown); 2],
                    false => [to - shown, to - counted],
                })
            } else {
                own
            };
        }
        if line.contains("M127") {
            shorter = false;
        }
        if let Some(own) = own {
            shown = (shown + own[0]).rem_euclid(360.0);
            if shown > 360.0 - 1e-9 {
                shown = 0.0;
            }
            counted += own[1];
            turns.push(own);
        }
    }
    turns
}

fn value_like(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
}

#[test]
fn pieces_across_0_are_right_on_an_axis_of_one_turn() {
    let open = "G0 A-20\nG1 X50 Y20 Z0 C12 F600\nX80 Y-10 C0\nX20 Y-40 C9\nX-20 Y-30 C0\nX-60 C5\n";
    let turned = "L A-20 FMAX\nL X+50 Y+20 Z+0 C+12 F600\nL X+80 Y-10 C+0\nL X+20 Y-40 C+9\nL X-20 Y-30 C+0\nL X-60 C+5\n";
    for (language, text, both) in [
        (Language::Siemens, siemens(open), true),
        (
            Language::Siemens,
            siemens(&format!("{open}X-50 C=DC(355)\nX5 C350\nC=ACP(4)\nC0\n")),
            false,
        ),
        (Language::Heidenhain, heidenhain(turned), true),
        (
            Language::Heidenhain,
            heidenhain(&format!(
                "{turned}L X-50 C+355 M126\nL X+5 C+350\nL C-2\nL C+4 M127\n"
            )),
            false,
        ),
    ] {
        let made = corrected(language, &text, true).unwrap_or_else(|error| panic!("{error}"));
        let turns = turns_by_hand(&made.text);
        let most = turns
            .iter()
            .fold(0.0, |most: f64, turn| match turn[0].abs() > most {
                true => turn[0].abs(),
                false => most,
            });
        assert!(turns.len() > 12 && most < 21.0, "{most}\n{}", made.text);
        // No angle but a step, or the shorter way, across 0.
        let crosses = ["IC", "DC(359", "C+359"];
        assert!(
            crosses.iter().any(|word| made.text.contains(word)),
            "{}",
            made.text
        );
        // Where nothing says how the axis counts, it is right both ways.
        let apart = |turn: &[f64; 2]| (turn[0] - turn[1]).abs() > 1e-9;
        assert!(!both || !turns.iter().any(apart), "{}", made.text);
    }
}

/// Turns of C by the words of a text on an axis that shows 0 to 360 deg, by hand, of a control that counts in so small steps, deg; what
/// has the same number is no turn, everything else is one.
fn strict_turns(text: &str, step: f64) -> Vec<f64> {
    let counts = |angle: f64| (angle / step).round() as i64;
    let whole = counts(360.0);
    let mut shown = 0;
    let mut turns = Vec::new();
    for word in text.split_whitespace() {
        let inside = |before: &str| {
            let value = word.strip_prefix(before)?.trim_end_matches(')');
            value.parse::<f64>().ok()
        };
        let turn = if let Some(by) = inside("C=IC(") {
            counts(by)
        } else if let Some(to) = inside("C=ACP(") {
            (counts(to) - shown).rem_euclid(whole)
        } else if let Some(to) = inside("C=ACN(") {
            -(shown - counts(to)).rem_euclid(whole)
        } else if let Some(to) = inside("C=DC(") {
            (counts(to) - shown + whole / 2).rem_euclid(whole) - whole / 2
        } else if let Some(to) = inside("C") {
            assert!((0.0..360.0).contains(&to), "{word}");
            counts(to) - shown
        } else {
            continue;
        };
        shown = (shown + turn).rem_euclid(whole);
        turns.push(turn as f64 * step);
    }
    turns
}

/// Words of all kinds, with few and with many digits, some of which do not turn, or all but not, or all but once round.
fn turning_program(chance: &mut Chance) -> String {
    let mut body = "G0 A-20 C=DC(0)\nG1 Z0 F600\n".to_owned();
    let mut shown = 0.0_f64;
    for _ in 0..6 {
        let digits = [0, 2, 4, 7][chance.below(4)];
        let rounded = |angle: f64| format!("{angle:.digits$}");
        let mut to: f64 = rounded(180.0 + chance.within(179.0)).parse().unwrap();
        let [x, y] = [(); 2].map(|()| chance.within(60.0).round());
        if chance.below(4) == 0 {
            // Where it stands, but for the digits.
            to = rounded(shown).parse::<f64>().unwrap().rem_euclid(360.0);
        }
        let is_special = chance.below(8) == 0;
        if is_special {
            // All but 0 or 360.
            to = [359.9999997, 359.999996, 359.99996, 0.0000004][chance.below(4)];
        }
        let digits = if is_special { 7 } else { digits };
        let rounded = |angle: f64| format!("{angle:.digits$}");
        let word = chance.of(&["DC", "ACP", "ACN", "IC", ""]);
        let turn = match word {
            "DC" => (to - shown + 180.0).rem_euclid(360.0) - 180.0,
            "ACP" => (to - shown).rem_euclid(360.0),
            "ACN" => -(shown - to).rem_euclid(360.0),
            "IC" => {
                to = chance.within(50.0);
                to = rounded(to).parse().unwrap();
                to
            }
            _ => to - shown,
        };
        // Where the source itself does all but no turn, or all but a whole one, it is the control that says which.
        let is_clear = |angle: f64| (turn - angle).abs() < 1e-9 || (turn - angle).abs() > 2e-3;
        let is_half = word == "DC" && (turn.abs() - 180.0).abs() < 2e-3;
        // So of an angle at which it may show 0.
        let is_open = word.is_empty() && shown > 360.0 - 2e-3;
        if is_half || is_open || ![0.0, 360.0, -360.0].into_iter().all(is_clear) {
            continue;
        }
        shown = (shown + turn).rem_euclid(360.0);
        let way = match chance.below(4) {
            0 => String::new(),
            _ => format!("X{x} Y{y} "),
        };
        body += &match word {
            "" => format!("{way}C{}\n", rounded(to)),
            word => format!("{way}C={word}({})\n", rounded(to)),
        };
    }
    siemens(&body)
}

/// What is rounded at the end of a piece makes no full circle of the next, on a control that counts finely, and on one that counts in
/// thousandths.
#[test]
fn no_piece_of_a_random_program_goes_round() {
    let mut written = 0;
    for seed in 0..400 {
        let text = turning_program(&mut Chance::new(seed));
        for turns in [false, true] {
            let made = match corrected(Language::Siemens, &text, turns) {
                Ok(made) => made,
                Err(error) => panic!("seed {seed}: {error}\n{text}"),
            };
            written += 1;
            for step in [1e-7, 1e-3] {
                // The rapid at the end goes to C0 straight on from wherever the axis stands.
                let of_cuts = |text: &str| {
                    let mut all = strict_turns(text, step);
                    all.pop();
                    all
                };
                let (all, own) = (of_cuts(&made.text), of_cuts(&text));
                let [sum, wanted] = [&all, &own].map(|turns| turns.iter().sum::<f64>());
                // A corrected pose turns by a degree more.
                let most_off = if turns { 2.0 } else { 0.05 };
                assert!(
                    (sum - wanted).abs() < most_off,
                    "seed {seed}, {step}: {sum} instead of {wanted}\n{text}\n{}",
                    made.text
                );
                let most = |turns: &[f64]| {
                    let larger = |one: f64, other: &f64| match other.abs() > one {
                        true => other.abs(),
                        false => one,
                    };
                    turns.iter().fold(0.0, larger)
                };
                let (largest, most) = (most(&all), most(&own));
                assert!(
                    largest <= most + most_off,
                    "seed {seed}, {step}: {largest} > {most}\n{text}\n{}",
                    made.text
                );
            }
        }
    }
    assert_eq!(written, 800);
}

/// MD30455, bit 2: said once, at the first place where it matters, with both readings.
#[test]
fn a_plain_angle_that_a_setting_of_the_machine_takes_as_dc_is_warned_of() {
    let said = |body: &str| {
        let program = read_as(Language::Siemens, &siemens(body)).unwrap();
        let findings = program.findings.into_iter();
        let of_setting = findings.filter(|finding| finding.message.contains("MD30455"));
        of_setting
            .map(|finding| (finding.line, finding.message))
            .collect::<Vec<_>>()
    };
    let found = said("G0 C=DC(350)\nG1 X5 C10 F600\nX9 C100\nX20 C300\nX30 C=AC(20)\nX40 C220\n");
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, 6);
    for part in [
        "axis C is sent to 10 deg",
        "taken as AC here, the basic setting, and turns by -340 deg",
        "makes it DC, it turns by 20 deg",
        "C=AC(10) or C=DC(10); so in 2 further lines: 8, 10",
    ] {
        assert!(found[0].1.contains(part), "{found:?}");
    }
    for agrees in [
        // Half a turn at most, ...
        "G0 C=DC(350)\nG1 X5 C200 F600\nX9 C50\n",
        // ... with a word, ...
        "G0 C=DC(350)\nG1 X5 C=AC(10) F600\nX9 C=DC(350)\nX10 C=IC(200)\n",
        // ... in the air, and on an axis that is not shown to count from 0 to 360.
        "G0 C=DC(350)\nC10\nG1 X5 F600\n",
        "G1 X5 C350 F600\nC0\n",
    ] {
        assert_eq!(said(agrees), [], "{agrees}");
    }
}
