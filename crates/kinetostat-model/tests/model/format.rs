//! The format as a whole: schema file, round trip, and no panic whatever the input.

use kinetostat::Pose;
use kinetostat_model::{Model, json_schema, preset_names, preset_text};
use nalgebra::Vector3;
use proptest::prelude::*;

/// `UPDATE_SCHEMA=1` writes the file anew.
#[test]
fn the_published_schema_is_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/schema/model.schema.json");
    if std::env::var_os("UPDATE_SCHEMA").is_some() {
        std::fs::write(path, json_schema()).expect("written");
    }
    let published = include_str!("../../schema/model.schema.json").replace("\r\n", "\n");
    assert!(
        published == json_schema(),
        "run: UPDATE_SCHEMA=1 cargo test --workspace --test model"
    );
    assert!(!published.contains("null"));
}

#[test]
fn a_model_that_is_written_and_read_is_the_same() {
    for preset in preset_names() {
        let model = Model::preset(preset.name).expect("preset");
        let written = model.to_toml().expect("written");
        let again = Model::from_toml(&written, "again.toml").unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(again.document, model.document, "{}", preset.name);
        assert_eq!(again.mechanism, model.mechanism, "{}", preset.name);
        assert_eq!(again.to_toml().expect("written"), written);
    }
}

#[test]
fn a_deviation_is_written_and_a_second_one_of_the_same_element_is_refused() {
    let model = Model::preset("orthoglide").expect("preset");
    let small = Pose::new(Vector3::new(1e-4, 0.0, 0.0), Vector3::new(0.0, 0.01, 0.0));
    let large = Pose::new(Vector3::new(2e-4, 0.0, 0.0), Vector3::zeros());
    let once = model.with_deviation("leg y", "line", &small).expect("once");
    let twice = once.with_deviation("leg y", "line", &large);
    let twice = twice.expect_err("one of both would be dropped").to_string();
    assert!(
        twice.contains("the limb 'leg y' has a deviation at 'line' already")
            && twice.contains("write both as one [[deviation]]"),
        "{twice}"
    );
    let both = once.with_deviation("leg y", "end", &small).expect("both");
    let all = both.with_deviation("leg z", "start", &small).expect("all");
    assert_eq!(all.document.deviation.len(), 3);
    for limb in all.mechanism.limbs() {
        assert_eq!(limb.nominal.elements().len(), limb.actual.elements().len());
        assert_eq!(limb.nominal.nodes(), limb.actual.nodes());
    }
    let again = Model::from_toml(&all.text, "again.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(again.mechanism, all.mechanism);
    let error = model
        .with_deviation("leg y", "lime", &small)
        .expect_err("no such element");
    assert!(
        error.to_string().contains("did you mean 'line'?"),
        "{error}"
    );
    let error = model
        .with_deviation("leg q", "line", &small)
        .expect_err("no such limb");
    assert!(
        error.to_string().contains("did you mean 'leg x'?"),
        "{error}"
    );
    let nan = Pose::translation(f64::NAN, 0.0, 0.0);
    let error = model
        .with_deviation("leg y", "line", &nan)
        .expect_err("not finite");
    assert!(
        error.to_string().contains("a finite number is needed"),
        "{error}"
    );
}

/// A deviation at the end of a limb is the tip sitting elsewhere on the platform.
#[test]
fn a_deviation_at_the_end_moves_the_tip_on_the_platform() {
    let model = Model::preset("puu3").expect("preset");
    let by = Vector3::new(1e-3, 2e-3, -1e-3);
    let moved = model
        .with_deviation("leg x", "end", &Pose::translation(by.x, by.y, by.z))
        .and_then(|m| m.with_deviation("leg y", "end", &turned(by, 1)))
        .and_then(|m| m.with_deviation("leg z", "end", &turned(by, 2)))
        .expect("moved");
    let rest = moved
        .mechanism
        .posture(&Pose::identity())
        .and_then(|p| p.deflected_by(&kinetostat::Wrench::zero()))
        .expect("rest");
    // All three tips sit `by` away on the platform, so the platform sits `-by` away.
    assert!(
        (rest.displacement.linear() + by).norm() < 1e-12,
        "{:?}",
        rest.displacement
    );
}

/// The same motion in the axes of the tips of legs y and z.
fn turned(by: Vector3<f64>, leg: usize) -> Pose {
    Pose::translation(by[leg], by[(leg + 1) % 3], by[(leg + 2) % 3])
}

fn preset_of(index: usize) -> &'static str {
    let names = preset_names();
    preset_text(names[index % names.len()].name).expect("preset")
}

fn floor_boundary(text: &str, index: usize) -> usize {
    (0..=index.min(text.len()))
        .rev()
        .find(|&i| text.is_char_boundary(i))
        .unwrap_or(0)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = Model::from_toml(&String::from_utf8_lossy(&bytes), "random.toml");
    }

    #[test]
    fn mutilated_presets_never_panic(
        preset in 0..preset_names().len(),
        cuts in proptest::collection::vec((any::<prop::sample::Index>(), 0usize..40, "[\\PC\\n]{0,6}"), 1..4),
    ) {
        let mut text = preset_of(preset).to_owned();
        for (at, length, insert) in cuts {
            let from = floor_boundary(&text, at.index(text.len()));
            let to = floor_boundary(&text, from + length).max(from);
            text.replace_range(from..to, &insert);
        }
        if let Err(error) = Model::from_toml(&text, "mutilated.toml") {
            prop_assert!(!error.problems().is_empty());
            prop_assert!(error.problems().iter().all(|p| p.line.is_some() && !p.message.is_empty()));
        }
    }

    #[test]
    fn extreme_numbers_never_panic(
        preset in 0..preset_names().len(),
        changes in proptest::collection::vec((any::<prop::sample::Index>(), 0usize..14), 1..5),
    ) {
        let extremes = [
            "0", "-1", "1e308", "-1e308", "1e-308", "5e-324", "1e200", "-1e-200", "nan", "inf",
            "9223372036854775807", "99999999999999999999", "true", "\"x\"",
        ];
        let mut text = preset_of(preset).to_owned();
        for (at, with) in changes {
            let numbers: Vec<(usize, usize)> = numbers(&text);
            let (from, to) = numbers[at.index(numbers.len())];
            text.replace_range(from..to, extremes[with]);
        }
        let _ = Model::from_toml(&text, "extreme.toml");
    }

    #[test]
    fn lost_and_doubled_lines_never_panic(preset in 0..preset_names().len(), line in any::<prop::sample::Index>(), double in any::<bool>()) {
        let mut lines: Vec<&str> = preset_of(preset).lines().collect();
        let i = line.index(lines.len());
        if double {
            lines.insert(i, lines[i]);
        } else {
            lines.remove(i);
        }
        let _ = Model::from_toml(&lines.join("\n"), "lines.toml");
    }
}

/// Places of the numbers behind `=`, `[` or `,`.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let mut i = 0;
    while i < bytes.len() {
        let starts = bytes[i].is_ascii_digit() || bytes[i] == b'-';
        if starts && i > 1 && b"=[, ".contains(&bytes[i - 1]) {
            let end = (i..bytes.len())
                .find(|&j| !b"0123456789.eE+-".contains(&bytes[j]))
                .unwrap_or(bytes.len());
            found.push((i, end));
            i = end;
        } else {
            i += 1;
        }
    }
    found
}
