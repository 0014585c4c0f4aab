//! Numbers by name: all are there, and a changed one gives the machine of the edited text.

use std::collections::BTreeSet;

use kinetostat_model::{Model, NumberEdit, Parameter, ParameterKind, preset_names};
use proptest::prelude::*;
use toml::{Table, Value};

/// A number in the text of a file, by keys and indices.
type Place = Vec<String>;

/// All floating-point numbers of a file, as the tree of its text has them; the whole number `schema` and counts are none.
fn numbers(value: &Value, at: &Place, found: &mut Vec<(Place, f64)>) {
    let inner = |step: &str| [at.as_slice(), &[step.to_owned()]].concat();
    match value {
        Value::Table(table) => {
            for (key, value) in table
                .iter()
                .filter(|(k, _)| !["schema", "segments"].contains(&k.as_str()))
            {
                numbers(value, &inner(key), found);
            }
        }
        Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                numbers(value, &inner(&i.to_string()), found);
            }
        }
        Value::Float(x) => found.push((at.clone(), *x)),
        Value::Integer(i) => found.push((at.clone(), *i as f64)),
        _ => {}
    }
}

/// The number at a place.
fn at<'v>(value: &'v mut Value, place: &[String]) -> &'v mut Value {
    let Some((first, rest)) = place.split_first() else {
        return value;
    };
    match value {
        Value::Table(table) => at(table.get_mut(first).expect("the key"), rest),
        Value::Array(list) => at(
            list.get_mut(first.parse::<usize>().expect("an index"))
                .expect("the entry"),
            rest,
        ),
        other => panic!("{other:?} has no {first}"),
    }
}

fn symmetric(place: &[String]) -> Option<Place> {
    let [rest @ .., key, i, j] = place else {
        return None;
    };
    let square = key.starts_with("matrix_") || key == "inertia_kg_m2";
    square.then(|| [rest, &[key.clone(), j.clone(), i.clone()]].concat())
}

/// What a person would call the number: written here once more, from the tree of the text alone.
fn path_of(tree: &Table, place: &[String]) -> String {
    let mut steps: Vec<String> = Vec::new();
    let mut value = &Value::Table(tree.clone());
    let mut keys: Vec<&str> = Vec::new();
    for step in place {
        let next = match value {
            Value::Table(table) => &table[step],
            Value::Array(list) => &list[step.parse::<usize>().expect("an index")],
            _ => panic!("{place:?}"),
        };
        let list = matches!(value, Value::Array(_));
        let text = |v: &Value, key: &str| v.get(key).and_then(Value::as_str).map(str::to_owned);
        let key = keys.last().copied().unwrap_or_default();
        if let (true, Value::Table(_)) = (list, next) {
            match key {
                "elements" => {
                    steps.pop();
                    let word = next.as_table().expect("an element").keys().find(|k| {
                        "rigid actuator passive spring spring6 link parallelogram coupled node body"
                            .split(' ')
                            .any(|w| w == k.as_str())
                    });
                    let word = word.expect("the element's word").clone();
                    let named = text(next, "name")
                        .or_else(|| text(next, "body").filter(|_| word == "body"));
                    let number = step.parse::<usize>().expect("an index") + 1;
                    steps.push(named.unwrap_or_else(|| format!("{word} {number}")));
                }
                "deviation" => {
                    steps.push(text(next, "limb").expect("its limb"));
                    steps.push(text(next, "at").expect("its place"));
                }
                "load" => {
                    let words = [
                        "wrench",
                        "spring",
                        "gas_spring",
                        "constant_tension",
                        "counterweight",
                    ];
                    steps.push(words.iter().find_map(|w| text(next, w)).expect("its name"));
                }
                "rotary_axis" => steps.push(text(next, "word").expect("its word")),
                "coupled" => {
                    steps.pop();
                    steps.push(text(next, "joint").expect("its joint"));
                }
                "axis" => {
                    steps.pop();
                    steps.push(text(next, "name").expect("its name"));
                }
                _ => steps.push(text(next, "name").expect("its name")),
            }
        } else if list {
            let index = step.parse::<usize>().expect("an index");
            let names: &[&str] = match key {
                "a_b_c_kuka_deg" => &["a", "b", "c"],
                k if k.starts_with("roll_pitch_yaw") => &["roll", "pitch", "yaw"],
                k if k.starts_with("homes") => &["1", "2", "3"],
                k if k.starts_with("limits") => &["least", "largest"],
                _ => &["x", "y", "z", "rx", "ry", "rz"],
            };
            steps.push(names[index].to_owned());
        } else {
            let through = matches!(next, Value::Table(_))
                && ["rigid", "spring6", "moved_by"].contains(&step.as_str());
            if !through {
                steps.push(step.clone());
            }
        }
        if !list {
            keys.push(step);
        }
        value = next;
    }
    steps.join(".")
}

/// Every number of every preset, changed by 1 %, gives the machine of the text in which it was edited, or is refused as that is.
#[test]
fn a_changed_parameter_is_the_edited_file() {
    let mut compared = 0;
    let mut refused = 0;
    for preset in preset_names() {
        let model = Model::preset(preset.name).expect("a preset");
        let tree: Table = model.text.parse().expect("a file");
        let mut found = Vec::new();
        numbers(&Value::Table(tree.clone()), &Vec::new(), &mut found);
        let listed = model.parameters();
        let mut seen = BTreeSet::new();
        for (place, value) in found {
            let mirrored = symmetric(&place);
            if mirrored.as_ref().is_some_and(|m| m < &place) {
                continue;
            }
            let path = path_of(&tree, &place);
            assert!(
                seen.insert(path.clone()),
                "{}: {path} is twice there",
                preset.name
            );
            let parameter = listed.iter().find(|p| p.path == path);
            let parameter =
                parameter.unwrap_or_else(|| panic!("{}: {path} is not listed", preset.name));
            assert_eq!(parameter.value.to_bits(), value.to_bits(), "{path}");
            let new = if value == 0.0 { 1e-3 } else { 1.01 * value };
            let mut edited = Value::Table(tree.clone());
            *at(&mut edited, &place) = Value::Float(new);
            if let Some(mirrored) = mirrored {
                *at(&mut edited, &mirrored) = Value::Float(new);
            }
            let text = toml::to_string(&edited).expect("a file");
            let by_text = Model::from_toml(&text, "edited");
            let parametric = model.parametric(&[&path]).expect("it is listed");
            let by_name = parametric.mechanism(&[new]);
            let as_model = model.with_parameters(&[(&path, new)]);
            match by_text {
                Ok(by_text) => {
                    assert_eq!(
                        by_name.expect("as the text"),
                        by_text.mechanism,
                        "{}: {path}",
                        preset.name
                    );
                    let as_model = as_model.expect("as the text");
                    assert_eq!(
                        as_model.mechanism, by_text.mechanism,
                        "{}: {path}",
                        preset.name
                    );
                    assert_eq!(as_model.document, by_text.document);
                    compared += 1;
                }
                Err(error) => {
                    let message = &error.problems()[0].message;
                    assert_eq!(
                        &by_name.expect_err("as the text").problems()[0].message,
                        message
                    );
                    assert_eq!(
                        &as_model.expect_err("as the text").problems()[0].message,
                        message
                    );
                    refused += 1;
                }
            }
        }
        let written = listed
            .iter()
            .filter(|p| p.kind != ParameterKind::Factor)
            .count();
        assert_eq!(written, seen.len(), "{}", preset.name);
    }
    assert!(
        compared > 2000 && refused < compared / 4,
        "{compared} compared, {refused} refused"
    );
}

fn find<'p>(all: &'p [Parameter], path: &str) -> &'p Parameter {
    all.iter()
        .find(|p| p.path == path)
        .unwrap_or_else(|| panic!("no {path}"))
}

#[test]
fn units_are_those_of_the_keys() {
    let orthoglide = Model::preset("orthoglide").expect("a preset").parameters();
    let kinds = [
        (
            "stiffness.bar.matrix_n_mm_rad.x.x",
            "N/mm",
            1e3,
            ParameterKind::Stiffness,
        ),
        (
            "stiffness.bar.matrix_n_mm_rad.y.rz",
            "N/rad",
            1.0,
            ParameterKind::CoupledStiffness,
        ),
        (
            "stiffness.bar.matrix_n_mm_rad.rx.rx",
            "N mm/rad",
            1e-3,
            ParameterKind::RotationalStiffness,
        ),
        ("stiffness.foot.along.y", "", 1.0, ParameterKind::Direction),
        (
            "section.foot beam.rigidities.axial_n",
            "N",
            1.0,
            ParameterKind::Rigidity,
        ),
        (
            "section.foot beam.rigidities.torsion_n_mm2",
            "N mm^2",
            1e-6,
            ParameterKind::Rigidity,
        ),
        ("section.foot beam.scale", "", 1.0, ParameterKind::Factor),
        (
            "platform.tool.home.position_mm.z",
            "mm",
            1e-3,
            ParameterKind::Length,
        ),
        (
            "chain.leg.slider.stiffness_n_per_mm",
            "N/mm",
            1e3,
            ParameterKind::Stiffness,
        ),
        ("workspace.corner_mm.x", "mm", 1e-3, ParameterKind::Length),
    ];
    for (path, unit, in_si, kind) in kinds {
        let p = find(&orthoglide, path);
        assert_eq!((p.unit, p.kind), (unit, kind), "{path}");
        assert!((p.in_si / in_si - 1.0).abs() < 1e-15, "{path}");
    }
    let heavy = Model::preset("heavy_6r").expect("a preset").parameters();
    let p = find(&heavy, "chain.arm.column mass.inertia_kg_m2.x.z");
    assert_eq!(
        (p.unit, p.kind, p.value),
        ("kg m^2", ParameterKind::Inertia, -4.93)
    );
    let p = find(&heavy, "mechanism.gravity_m_per_s2.z");
    assert_eq!(
        (p.unit, p.kind, p.value),
        ("m/s^2", ParameterKind::Acceleration, -9.81)
    );
    // Whatever has no unit is known to have none.
    for preset in preset_names() {
        for p in Model::preset(preset.name).expect("a preset").parameters() {
            let bare = ["scale", "ratio", "exponent", "poissons_ratio"];
            let vector = ["axis", "along", "about", "axes", "quaternion"]
                .iter()
                .any(|w| p.path.contains(w));
            assert!(
                !p.unit.is_empty() || vector || bare.iter().any(|w| p.path.ends_with(w)),
                "{}",
                p.path
            );
        }
    }
}

fn assert_none_unused(model: &Model) {
    let unused = model
        .warnings
        .iter()
        .find(|w| w.message.contains("nothing uses"));
    assert!(unused.is_none(), "{unused:?}");
}

/// A limb's own number counts before the chain's; the other limbs keep theirs.
#[test]
fn a_limb_has_numbers_of_its_own() {
    let model = Model::preset("orthoglide").expect("a preset");
    let limbs = |m: &kinetostat::Mechanism| -> Vec<_> {
        m.limbs().iter().map(|l| l.nominal.clone()).collect()
    };
    let paths = [
        (
            "chain.leg.q2.length_mm",
            "limb.leg y.q2.length_mm",
            311.0,
            312.0,
        ),
        (
            "stiffness.bar.scale",
            "limb.leg y.stiffness.bar.scale",
            1.1,
            1.2,
        ),
        (
            "section.foot beam.scale",
            "limb.leg y.section.foot beam.scale",
            0.9,
            0.8,
        ),
        (
            "section.foot beam.rigidities.axial_n",
            "limb.leg y.section.foot beam.rigidities.axial_n",
            2e7,
            1e7,
        ),
    ];
    let nominal = limbs(&model.mechanism);
    for (all, own, shared, single) in paths {
        let only_shared = limbs(
            &model
                .with_parameters(&[(all, shared)])
                .expect("a machine")
                .mechanism,
        );
        let shared_single = limbs(
            &model
                .with_parameters(&[(all, single)])
                .expect("a machine")
                .mechanism,
        );
        for order in [
            [(all, shared), (own, single)],
            [(own, single), (all, shared)],
        ] {
            let both = model.with_parameters(&order).expect("a machine");
            assert_none_unused(&both);
            let (names, values): (Vec<&str>, Vec<f64>) = order.into_iter().unzip();
            let fast = model
                .parametric(&names)
                .expect("both exist")
                .mechanism(&values)
                .expect("a machine");
            assert_eq!(fast, both.mechanism);
            let both = limbs(&both.mechanism);
            assert_eq!(
                [&both[0], &both[2]],
                [&only_shared[0], &only_shared[2]],
                "{all}"
            );
            assert_eq!(both[1], shared_single[1], "{own}");
        }
        let only_own = limbs(
            &model
                .with_parameters(&[(own, single)])
                .expect("a machine")
                .mechanism,
        );
        assert_eq!([&only_own[0], &only_own[2]], [&nominal[0], &nominal[2]]);
        assert_eq!(only_own[1], shared_single[1]);
        assert_ne!(only_own[1], nominal[1]);
    }
    // All limbs on their own: nothing is left unused.
    let own = ["leg x", "leg y", "leg z"].map(|l| format!("limb.{l}.stiffness.bar.scale"));
    let changes: Vec<(&str, f64)> = own.iter().map(|p| (p.as_str(), 1.05)).collect();
    let changed = model.with_parameters(&changes).expect("a machine");
    assert_none_unused(&changed);
    let shared = model
        .with_parameters(&[("stiffness.bar.scale", 1.05)])
        .expect("a machine");
    assert_eq!(changed.mechanism, shared.mechanism);
}

/// Deviations that the file does not have are zero, and become what a file with them says.
#[test]
fn deviations_are_made_where_they_are_named() {
    let model = Model::preset("orthoglide").expect("a preset");
    let paths = [
        "deviation.leg x.q2.longer_by_mm",
        "deviation.leg y.foot arm.translation_mm.z",
        "deviation.leg y.foot arm.rotation_vector_deg.x",
        "deviation.leg z.end.rotation_vector_deg.y",
    ];
    let parametric = model.parametric(&paths).expect("places exist");
    assert!(parametric.parameters().iter().all(|p| p.value == 0.0));
    let by_name = parametric
        .mechanism(&[0.1, 0.2, 0.3, 0.4])
        .expect("a machine");
    let text = format!(
        "{}\n[[deviation]]\nlimb = \"leg x\"\nat = \"q2\"\nlonger_by_mm = 0.1\n\
         [[deviation]]\nlimb = \"leg y\"\nat = \"foot arm\"\nmoved_by = {{ translation_mm = [0, 0, 0.2], rotation_vector_deg = [0.3, 0, 0] }}\n\
         [[deviation]]\nlimb = \"leg z\"\nat = \"end\"\nmoved_by = {{ rotation_vector_deg = [0, 0.4, 0] }}\n",
        model.text
    );
    assert_eq!(
        by_name,
        Model::from_toml(&text, "deviating")
            .expect("a file")
            .mechanism
    );
    // Of another form than the file's: named as what does not exist.
    let file = Model::from_toml(&text, "deviating").expect("a file");
    let refused = file
        .parametric(&["deviation.leg x.q2.translation_mm.x"])
        .expect_err("it is longer there");
    assert!(
        refused.to_string().contains("there is no parameter"),
        "{refused}"
    );
    assert!(
        refused
            .to_string()
            .contains("deviation.leg x.q2.longer_by_mm"),
        "{refused}"
    );
}

#[test]
fn a_scale_is_a_factor_on_all_that_bends() {
    // A material by name, moduli, rigidities, a matrix: the tip bends less by the factor.
    let text = |material: &str| {
        format!(
            "schema = 1\n[mechanism]\nname = \"m\"\n[[platform]]\nname = \"tool\"\nhome = {{ position_mm = [500, 0, 0] }}\n\
             [section.bar]\nround = {{ diameter_mm = 20 }}\n{material}\n\
             [chain.arm]\nelements = [ {{ link = \"bar\", length_mm = 500 }} ]\n\
             [[limb]]\nname = \"arm\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"arm\"\n"
        )
    };
    for material in [
        "material = \"aluminium\"",
        "youngs_modulus_gpa = 70\npoissons_ratio = 0.3",
    ] {
        let model = Model::from_toml(&text(material), "bar.toml").expect("a model");
        let home = model.mechanism.platforms()[1].home;
        let stiffness = |m: &kinetostat::Mechanism| {
            let posture = m.posture(&home).expect("a posture");
            posture.stiffness().expect("an answer").cartesian.matrix
        };
        let nominal = stiffness(&model.mechanism);
        let scaled = model
            .with_parameters(&[("section.bar.scale", 1.25)])
            .expect("a machine");
        let ratio = stiffness(&scaled.mechanism).component_div(&nominal);
        for i in [0, 1, 2, 3, 4, 5] {
            assert!((ratio[(i, i)] - 1.25).abs() < 1e-9, "{ratio}");
        }
    }
}

#[test]
fn nonsense_is_refused_with_the_words_of_the_file() {
    let model = Model::preset("orthoglide").expect("a preset");
    let length = "chain.leg.q2.length_mm";
    for (value, message) in [
        (f64::NAN, "a finite number is needed"),
        (f64::INFINITY, "a finite number is needed"),
        (-1.0, "a number above zero is needed"),
        (0.0, "a number above zero is needed"),
    ] {
        let by_name = model
            .parametric(&[length])
            .expect("it exists")
            .mechanism(&[value]);
        for text in [
            by_name.expect_err("nonsense").to_string(),
            model
                .with_parameters(&[(length, value)])
                .expect_err("nonsense")
                .to_string(),
        ] {
            assert!(
                text.contains(message) && text.contains("length_mm"),
                "{text}"
            );
        }
    }
    let wrong = model
        .parametric(&["chain.leg.q2.lenght_mm"])
        .expect_err("misspelt")
        .to_string();
    assert!(
        wrong.contains("there is no parameter 'chain.leg.q2.lenght_mm'"),
        "{wrong}"
    );
    assert!(wrong.contains(length), "{wrong}");
    let twice = model
        .parametric(&[length, length])
        .expect_err("twice")
        .to_string();
    assert!(twice.contains("is given twice"), "{twice}");
    let count = model
        .parametric(&[length])
        .expect("it exists")
        .mechanism(&[1.0, 2.0]);
    assert!(
        count
            .expect_err("two")
            .to_string()
            .contains("1 values are needed, 2 are given")
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    /// Any numbers together: the fast way and the file agree.
    #[test]
    fn many_numbers_at_once_are_the_file(
        preset in proptest::sample::select(preset_names().iter().map(|p| p.name).collect::<Vec<_>>()),
        picks in proptest::collection::vec((any::<proptest::sample::Index>(), 0.97..1.03_f64), 1..8),
    ) {
        let model = Model::preset(preset).expect("a preset");
        let all = model.parameters();
        let mut changes: Vec<(&str, f64)> = Vec::new();
        for (pick, factor) in &picks {
            let p = pick.get(&all);
            if changes.iter().all(|(path, _)| *path != p.path) {
                changes.push((&p.path, p.value * factor));
            }
        }
        let (paths, values): (Vec<&str>, Vec<f64>) = changes.iter().copied().unzip();
        let fast = model.parametric(&paths).expect("listed").mechanism(&values);
        let slow = model.with_parameters(&changes).map(|m| m.mechanism);
        match (fast, slow) {
            (Ok(fast), Ok(slow)) => prop_assert_eq!(fast, slow),
            (Err(fast), Err(slow)) => prop_assert_eq!(fast.to_string(), slow.to_string()),
            (fast, slow) => prop_assert!(false, "{:?} {:?}", fast.err(), slow.err()),
        }
    }
}

/// Numbers are changed where they stand; comments, order and the rest of the text stay.
#[test]
fn numbers_are_changed_in_the_text() {
    let text = "schema = 1\n# my machine\n[mechanism]\nname = \"m\"\n[[platform]]\nname = \"tool\"\nhome = { position_mm = [500, 0, 0] }\n[section.bar] # steel\nmaterial = \"steel\"\ntube = { outer_diameter_mm = 80, inner_diameter_mm = 60 } # measured\n[stiffness.cast]\nmatrix_n_m_rad = [\n  [2e8, 0, 0, 0, 0, 0],\n  [0, 2e7, 0, 0, 0, 1e6],\n  [0, 0, 2e7, 0, -1e6, 0],\n  [0, 0, 0, 1e6, 0, 0],\n  [0, 0, -1e6, 0, 2e6, 0],\n  [0, 1e6, 0, 0, 0, 2e6],\n]\n[chain.arm]\nelements = [\n  # first\n  { actuator = \"revolute\", name = \"A1\", axis = \"z\", stiffness_n_m_per_rad = 1e6 }, # drive\n  { spring6 = \"cast\" },\n]\n[[chain.arm.elements]]\nlink = \"bar\"\n";
    let text = text.replace("]\n[[chain.arm.elements]]\nlink = \"bar\"\n", "  { link = \"bar\", length_mm = 500, source = \"drawing\" },\n]\n[[limb]]\nname = \"arm\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"arm\"\n");
    let model = Model::from_toml(&text, "m.toml").unwrap();
    let edit = |path: &str, value: f64, source: Option<&str>| NumberEdit {
        path: path.to_owned(),
        value,
        source: source.map(str::to_owned),
    };
    let changed = model
        .edited(&[
            edit(
                "chain.arm.A1.stiffness_n_m_per_rad",
                1_234_567.891_23,
                Some("measured, \"3 %\""),
            ),
            edit("chain.arm.link 3.length_mm", 501.5, Some("measured")),
            edit("section.bar.tube.outer_diameter_mm", 79.0, Some("caliper")),
            edit("stiffness.cast.matrix_n_m_rad.y.rz", 1.5e6, None),
        ])
        .unwrap();
    let want = [
        "stiffness_n_m_per_rad = 1234567.89, source = \"measured, \\\"3 %\\\"\" }, # drive",
        "length_mm = 501.5, source = \"measured\" },",
        "material = \"steel\"\nsource = \"caliper\"\n",
        "outer_diameter_mm = 79.0, inner_diameter_mm = 60 } # measured\n",
        "[0, 2e7, 0, 0, 0, 1500000.0]",
        "[0, 1500000.0, 0, 0, 0, 2e6]",
        "# my machine\n",
        "  # first\n",
    ];
    for part in want {
        let own = changed
            .text
            .replace("'measured, \"3 %\"'", "\"measured, \\\"3 %\\\"\"");
        assert!(own.contains(part), "{part}\n{own}");
    }
    // A number of one limb does not stand in the file; the document is written anew with it.
    let own = model
        .edited(&[edit("limb.arm.link 3.length_mm", 502.0, None)])
        .unwrap();
    assert_ne!(own.mechanism, model.mechanism);
}
