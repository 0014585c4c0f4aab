//! Orientations under the name of their convention, against another library's matrices.

use kinetostat_model::Model;
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::Matrix3;
use serde_json::Value;

#[test]
fn figures_of_every_convention_against_an_independent_library() {
    let golden: Value =
        serde_json::from_str(include_str!("golden/orientations.json")).expect("JSON");
    let text = kinetostat_model::preset_text("two_link").expect("preset");
    let document = Model::from_toml(text, "two_link.toml")
        .expect("a model")
        .document;
    let mut counts = std::collections::BTreeMap::new();
    let mut worst = Worst::new();
    for case in golden["cases"].as_array().expect("cases") {
        let key = case["key"].as_str().expect("a convention");
        *counts.entry(key).or_insert(0) += 1;
        let mut changed = document.clone();
        let platform = changed.platform.last_mut().expect("a platform");
        platform.home =
            toml::from_str(&format!("{key} = {}", case["numbers"])).expect("a placement");
        let model = Model::from_document(&changed, "turned").unwrap_or_else(|e| panic!("{e}"));
        let m = &model.mechanism;
        let found = m.platforms()[m.tool()].home.rotation.to_rotation_matrix();
        let expected = Matrix3::from_fn(|i, j| case["matrix"][i][j].as_f64().expect("a number"));
        worst.add((found.matrix() - expected).largest_entry());
    }
    assert_eq!(counts.len(), 7);
    assert!(counts.values().all(|n| *n >= 20), "{counts:?}");
    let worst = worst.of(counts.values().sum());
    let holds = worst < 1e-14;
    let figure = serde_json::json!({
        "name": "Orientations of 7 conventions, 20 to 24 each, minus SciPy's matrices",
        "measured": worst, "asked": "at most 1e-14", "unit": "of 1", "holds": holds,
    });
    println!("figure {figure}");
    assert!(holds, "{figure}");
}
