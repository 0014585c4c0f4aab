//! Papers of made-up runs: what stands in them, in all languages.

use kinetostat_machining::{
    ActuatorColumn, FeatureResult, FileRead, ForceBand, PointResult, RunResult, Warning,
    WarningCode,
};

use crate::paper::content::contents;
use crate::paper::language::Language;
use crate::paper::question::{Paper, VerifiedProgram};
use crate::run::Shown;

/// A run with everything that a paper speaks of, with a feature that is missed and names that are hard to write.
fn run() -> RunResult {
    let mut result = RunResult::default();
    let s = &mut result.summary;
    (s.points, s.converged, s.stable) = (1234, true, true);
    s.max_position_error_before_mm = 0.7583;
    s.max_position_error_after_mm = 0.000_57;
    s.max_residual_rotation_deg = 0.42;
    s.max_actuator_force = vec![812.5];
    (s.corner_steps, s.largest_corner_step_mm) = (3, 0.0171);
    (s.entry_steps, s.largest_entry_step_mm) = (2, 0.577);
    s.max_corner_error_if_load_turns_mm = Some(0.000_3);
    s.max_corner_error_if_load_follows_feed_mm = Some(0.021_4);
    (s.feed_limited_pieces, s.max_feed_factor) = (4, 1.5);
    s.largest_backward_step_mm = 0.0333;
    s.max_displacement_by_weight_mm = Some(0.0912);
    s.max_error_by_own_weight_mm = Some(0.0912);
    let q = &mut result.run_inputs;
    q.compensated = true;
    q.tolerance_mm = 0.000_5;
    q.chord_tolerance_mm = 0.000_4;
    q.decimals = 4;
    s_names(q);
    let mut feature = FeatureResult::default();
    feature.name = "Tasche größer".to_owned();
    feature.lines = [4, 9];
    feature.error_before_mm = Some(0.61);
    feature.error_after_mm = Some(0.000_37);
    feature.allowed_mm = 0.0002;
    feature.held = Some(false);
    result.features.push(feature);
    let mut band = ForceBand::default();
    (band.spread_percent, band.points, band.of_points, band.line) = (25.0, 9, 99, 17);
    band.max_error_if_larger_mm = Some(0.1234);
    band.max_error_if_smaller_mm = Some(0.0456);
    result.force_band = Some(band);
    let mut point = PointResult::default();
    (point.line, point.output_line, point.stable) = (77, 88, true);
    point.error_before_mm = [0.3, 0.0, 0.4];
    point.force_n = [100.0, 0.0, 0.0];
    result.points.push(point.clone());
    result.worst_points.push(point.clone());
    (point.line, point.output_line) = (4321, 4444);
    point.error_after_mm = [0.0, 0.000_44, 0.0];
    result.worst_points_after.push(point);
    let warning = Warning::at_line(WarningCode::Writing, 5, "a step against the motion");
    result.warnings.push(warning);
    result.assess();
    result
}

fn s_names(q: &mut kinetostat_machining::RunInputs) {
    q.program = format!(
        "/Auftrag/{}/größer_élévé_中.ngc",
        "sehr_langer_Ordner".repeat(12)
    );
    q.model = "Ärm <b>".to_owned();
    q.stiffnesses = vec!["'slider' 1.00e6 N/mm".to_owned()];
    q.files.push(FileRead {
        what: "program".to_owned(),
        name: "größer.ngc".to_owned(),
        sha256: "ab".repeat(32),
    });
    let mut drive = ActuatorColumn::default();
    (drive.name, drive.motion_unit, drive.force_unit) =
        ("q1".to_owned(), "deg".to_owned(), "N m".to_owned());
    drive.rating = Some(1000.0);
    q.actuators.push(drive);
}

fn said(paper: &Paper<'_>) -> String {
    contents(paper, &Shown::of_result(paper.result)).text()
}

#[test]
fn pages_in_every_language_have_pictures_in_its_words() {
    let mut result = run();
    for x in [10.0, 20.0] {
        let mut point = PointResult::default();
        (point.path_mm, point.position_mm) = (x, [x, 0.5 * x, 0.0]);
        point.error_before_mm = [0.025 * x, 0.0, 0.0];
        result.points.push(point);
    }
    for (language, words) in [
        (Language::English, "programmed path"),
        (Language::French, "trajectoire programmée"),
        (Language::German, "programmierte Bahn"),
    ] {
        let paper = Paper::of(&result).in_language(language);
        let page = paper.html();
        assert_eq!(page.matches("<img").count(), 2, "{page}");
        assert!(page.contains(words), "{language:?}");
        assert_eq!(page.contains("%3E0,2%3C"), language != Language::English);
    }
}

#[cfg(feature = "pdf")]
#[test]
fn pages_of_a_pdf_have_the_pictures() {
    use crate::paper::block::Block;
    use crate::paper::typeset::pictures_of;
    let result = run();
    for language in [Language::English, Language::German, Language::French] {
        // Letters that the paper has none of, in a drawing.
        let machine = crate::MachineShown {
            page: String::new(),
            picture: "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 400 300\" width=\"400\" height=\"300\"><style>text{font-family:system-ui,sans-serif}</style><text x=\"9\" y=\"20\">中 ↑ Ж</text></svg>\n".to_owned(),
            line: 7,
        };
        let paper = Paper::of(&result)
            .in_language(language)
            .with_machine(Some(&machine));
        assert!(paper.pdf().is_ok());
        let contents = contents(&paper, &Shown::of_result(&result));
        let is_picture = |block: &&Block| matches!(block, Block::Picture { .. });
        let wanted = contents.blocks.iter().filter(is_picture).count();
        let found = pictures_of(&contents);
        assert_eq!((found.len(), wanted), (3, 3));
        for [x, y, width, height] in found {
            assert!(width > 200.0 && height > 150.0, "{width} {height}");
            let inside = x > 61.9 && x + width < 547.4 && y > 65.9 && y + height < 782.0;
            assert!(inside, "{x} {y} {width} {height}");
        }
    }
}

#[test]
fn every_language_states_the_same_figures() {
    let result = run();
    for language in Language::ALL {
        let text = said(&Paper::of(&result).in_language(language));
        let plain = text.replace('\u{202f}', " ");
        // Largest figures are rounded up; the share is 812.5 of 1000.
        let figures = [
            "0.759 mm",
            "0.570 µm",
            "0.0912 mm",
            "0.0171 mm",
            "0.577 mm",
            "0.124 mm",
            "0.0333 mm",
            "0.610 mm",
            "0.370 µm",
            "0.2 µm",
            "0.500 mm",
            "81.3 %",
            "813 N m",
            "0.420",
            "1 234",
            "25 %",
            // Only in the list of the worst places with compensation.
            "4 321",
            "0.440 µm",
        ];
        for figure in figures {
            let figure = match language {
                Language::English => figure.to_owned(),
                Language::French | Language::German => figure.replace('.', ","),
            };
            assert!(
                plain.contains(&figure),
                "{language:?}: {figure} in\n{plain}"
            );
        }
        // No text to fill in is left, and no sentence is English in another language.
        assert!(!text.contains('{') && !text.contains('}'), "{text}");
        let english = ["tool", "without", "allowed", "stiffness against", "kept"];
        for word in english
            .into_iter()
            .filter(|_| language != Language::English)
        {
            assert!(!text.contains(word), "{language:?}: {word} in\n{text}");
        }
    }
}

#[test]
fn every_statement_of_the_html_report_is_in_the_paper() {
    let result = run();
    let text = said(&Paper::of(&result));
    for statement in crate::run::meaning::assessment(&result).statements {
        assert!(text.contains(&statement.sentence(&result)), "{statement:?}");
    }
    let shown = Shown::of_result(&result);
    for left in crate::run::facts::left(&shown) {
        for language in Language::ALL {
            let [name, size, words] = crate::paper::words::left(language, left, &shown);
            let text = said(&Paper::of(&result).in_language(language));
            assert!(
                text.contains(&format!("{name}: {size}: {words}")),
                "{left:?}"
            );
        }
    }
    for warning in &result.warnings {
        assert!(text.contains(&warning.to_string()));
    }
}

#[test]
fn a_run_of_nothing_and_one_that_must_not_run_say_so() {
    let words = ["nothing to judge", "rien à juger", "nichts zu beurteilen"];
    for (language, expected) in Language::ALL.into_iter().zip(words) {
        let text = said(&Paper::of(&RunResult::default()).in_language(language));
        assert!(text.contains(expected), "{text}");
    }
    let mut result = run();
    result.summary.stable = false;
    result.assess();
    let words = ["Do not run", "Ne pas exécuter", "Nicht ausführen"];
    for (language, expected) in Language::ALL.into_iter().zip(words) {
        let text = said(&Paper::of(&result).in_language(language));
        assert!(text.contains(expected), "{text}");
    }
}

#[test]
fn a_verified_program_has_its_own_verdict() {
    let result = run();
    let paper = Paper::of(&result)
        .in_language(Language::German)
        .of_verified(VerifiedProgram {
            original: "vorlage.ngc".to_owned(),
            held: false,
            allowed_mm: 0.001,
            uncut: vec![([4, 6], 12.5), ([8, 8], 2.5)],
            rapids: vec![(9, 6.0)],
            extra_cuts: vec![(12, 40.0)],
            other_words: vec![14],
        });
    let text = said(&paper);
    assert!(text.contains("Toleranz verfehlt"), "{text}");
    assert!(text.contains("Die Zeilen 4 bis 6 des Originals"), "{text}");
    assert!(text.contains("Die Zeile 8 des Originals"), "{text}");
    assert!(text.contains("vorlage.ngc"), "{text}");
    assert!(text.contains("Der Eilgang in Zeile 9"), "{text}");
    assert!(text.contains("Zeile 12 dieses Programms"), "{text}");
    assert!(
        text.contains("In Zeile 14 hat dieses Programm einen anderen Vorschub"),
        "{text}"
    );
    // The other reading of the load at its steps is solved for it as for a compensated program.
    assert!(
        text.contains("liegt das Werkzeug dort bis zu 0,0214\u{202f}mm ab"),
        "{text}"
    );
}

#[test]
fn a_missed_tolerance_without_a_reason_has_no_empty_one() {
    let mut result = run();
    result.summary.max_position_error_after_mm = 0.04;
    result.assess();
    result.tolerance.missed = Some(kinetostat_machining::MissedTolerance {
        line: 12,
        ..kinetostat_machining::MissedTolerance::default()
    });
    let words = [
        "most at line 12. Without",
        "surtout à la ligne 12. Sans",
        "am meisten in Zeile 12. Ohne",
    ];
    for (language, expected) in Language::ALL.into_iter().zip(words) {
        let text = said(&Paper::of(&result).in_language(language)).replace('\u{a0}', " ");
        assert!(text.contains(expected), "{text}");
    }
    let known = "the force changes faster";
    let with_reason = |missed: &mut kinetostat_machining::MissedTolerance| {
        missed.reason = known.to_owned();
    };
    result.tolerance.missed.iter_mut().for_each(with_reason);
    let text = said(&Paper::of(&result));
    assert!(
        text.contains("most at line 12: the force changes faster."),
        "{text}"
    );
}

#[test]
fn names_are_harmless_in_html() {
    let result = run();
    let page = Paper::of(&result).in_language(Language::French).html();
    assert!(page.contains("Ärm &lt;b&gt;") && !page.contains("Ärm <b>"));
    assert!(page.contains("lang=\"fr\""));
}

#[cfg(feature = "pdf")]
#[test]
fn a_pdf_is_the_same_twice_whatever_the_names_are() {
    let dated = {
        let mut result = run();
        result.run_inputs.date = Some("2026-11-20".to_owned());
        result
    };
    for (language, result) in Language::ALL
        .into_iter()
        .flat_map(|language| [(language, &dated), (language, &run())].map(|(l, r)| (l, r.clone())))
    {
        let paper = Paper::of(&result).in_language(language);
        let bytes = paper.pdf().expect("a paper");
        assert!(bytes.starts_with(b"%PDF-1.") && bytes.trim_ascii_end().ends_with(b"%%EOF"));
        assert!(bytes == paper.pdf().expect("a paper"), "{language:?}");
    }
}
