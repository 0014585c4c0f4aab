//! `view`: the page gets the same figures as the other commands give.

use serde_json::{Value, json};

use crate::common::run;
use crate::common::served::Served;

fn here() -> tempfile::TempDir {
    tempfile::tempdir().expect("a directory")
}

#[test]
fn a_state_has_the_figures_of_deflect_and_shares() {
    let here = here();
    let served = Served::of(here.path(), &["heavy_6r"]);
    let (code, machine) = served.post("machine", &json!({}));
    assert_eq!(
        (code, machine["actuators"].as_array().map(Vec::len)),
        (200, Some(6))
    );
    assert_eq!(served.post("path", &json!({})), (200, Value::Null));
    let home = machine["actuators"].as_array().expect("a list");
    let mut joints: Vec<f64> = home
        .iter()
        .map(|a| a["home"].as_f64().expect("a number"))
        .collect();
    joints[0] += 20.0;
    let (code, state) = served.state(&json!({ "actuators": joints, "force_n": [300, -200, -900] }));
    assert_eq!(code, 200, "{state}");
    // The command that the page offers to copy says the same.
    let cli = state["cli"].as_str().expect("a text");
    let mut words: Vec<String> = Vec::new();
    for (k, part) in cli.split('\'').enumerate() {
        match k % 2 {
            0 => words.extend(part.split_whitespace().map(str::to_owned)),
            _ => words.push(part.to_owned()),
        }
    }
    words.push("--json".to_owned());
    let words: Vec<&str> = words[1..].iter().map(String::as_str).collect();
    let said: Value = serde_json::from_str(&run(here.path(), &words).answered().out).expect("JSON");
    for key in ["displacement_mm", "displacement_by_load_mm"] {
        assert_eq!(state[key], said[key], "{key}");
    }
    assert_eq!(
        state["limb_loads"][0]["force_n"],
        said["limbs"][0]["force_n"]
    );
    assert_eq!(state["stable"], said["stable"]);
    let turn = |v: &Value, unit: f64| -> Vec<f64> {
        v.as_array()
            .expect("a list")
            .iter()
            .map(|x| unit * x.as_f64().expect("a number"))
            .collect()
    };
    let (shown, wanted) = (
        turn(&state["turn_mrad"], 1e-3),
        turn(&said["rotation_vector_deg"], 1f64.to_radians()),
    );
    for (shown, wanted) in shown.iter().zip(&wanted) {
        assert!((shown - wanted).abs() < 1e-12, "{shown} {wanted}");
    }
    let sum: f64 = state["shares"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|s| s["percent"].as_f64().expect("a number"))
        .sum();
    assert!((90.0..=110.0).contains(&sum), "{sum}");
    let bars = |scene: &str| state[scene]["bars"].as_array().map(Vec::len);
    assert_eq!(bars("scene"), bars("deflected"));
}

#[test]
fn modes_are_those_of_the_command() {
    let here = here();
    let served = Served::of(here.path(), &["heavy_6r"]);
    let (code, found) = served.post("modes", &json!({}));
    assert_eq!(code, 200, "{found}");
    let said = run(here.path(), &["modes", "heavy_6r", "--json"]).answered();
    let said: Value = serde_json::from_str(&said.out).expect("JSON");
    let modes = found["modes"].as_array().expect("a list");
    assert_eq!(modes.len(), 6);
    for (mode, wanted) in modes.iter().zip(said["modes"].as_array().expect("a list")) {
        assert_eq!(mode["frequency_hz"], wanted["frequency_hz"]);
        assert_eq!(
            mode["moved"]["bars"].as_array().map(Vec::len),
            found["from"]["bars"].as_array().map(Vec::len)
        );
    }
    let massless = Served::of(here.path(), &["orthoglide"]);
    let (code, refused) = massless.post("modes", &json!({}));
    assert_eq!(
        (code, &refused["error"]["code"]),
        (422, &json!("model_unsuited"))
    );
}

#[test]
fn a_load_that_grows_is_that_of_the_command() {
    let here = here();
    let served = Served::of(here.path(), &["orthoglide"]);
    let state = json!({ "force_n": [100, 50, -2000] });
    let (code, found) = served.post("curve", &json!({ "state": state, "factor": 10 }));
    assert_eq!(code, 200, "{found}");
    let line = "curve orthoglide --force 100 50 -2000 --factor 0 10 --json";
    let said = run(here.path(), &line.split(' ').collect::<Vec<_>>()).answered();
    let said: Value = serde_json::from_str(&said.out).expect("JSON");
    assert_eq!(
        found["branches"].as_array().map(Vec::len),
        said["branches"].as_array().map(Vec::len)
    );
    let number = |v: &Value| v.as_f64().expect("a number");
    let last = |v: &Value| {
        v.as_array()
            .and_then(|all| all.last().cloned())
            .expect("a point")
    };
    let (own, wanted) = (
        last(&found["branches"][0]["places"]),
        last(&said["branches"][0]["points"]),
    );
    assert_eq!(number(&own["factor"]), 10.0);
    let apart = number(&own["along"]) - number(&wanted["displacement_mm"]);
    assert!(apart.abs() < 1e-9, "{own} {wanted}");
    assert_eq!(own["stable"], wanted["stable_under_dead_load"]);
    assert!(own["shape"]["bars"].is_array());
    // Without a load there is nothing to grow, and a machine that nothing holds goes anywhere.
    for (model, state, code) in [
        ("orthoglide", json!({}), "missing"),
        (
            "three_link_z",
            json!({ "force_n": [-1, 0, 0] }),
            "model_unsuited",
        ),
    ] {
        let served = Served::of(here.path(), &[model]);
        let (status, refused) = served.post("curve", &json!({ "state": state, "factor": 10 }));
        assert_eq!(
            (status, &refused["error"]["code"]),
            (422, &json!(code)),
            "{refused}"
        );
    }
}

/// JSON of a command.
fn said(here: &std::path::Path, line: &str) -> Value {
    let answer = run(here, &line.split(' ').collect::<Vec<_>>()).answered();
    serde_json::from_str(&answer.out).expect("JSON")
}

fn numbers(v: &Value) -> Vec<f64> {
    let all = v.as_array().expect("a list");
    all.iter().map(|x| x.as_f64().expect("a number")).collect()
}

#[test]
fn a_map_is_that_of_the_command() {
    let here = here();
    let served = Served::of(here.path(), &["orthoglide"]);
    let (_, machine) = served.post("machine", &json!({}));
    let names = |v: &Value| v["name"].as_str().map(str::to_owned);
    let offered: Vec<_> = machine["variables"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(names)
        .collect();
    assert!(offered.iter().any(|name| name == "stiffness_softest"));
    // It has no masses and no ratings.
    assert!(
        !offered
            .iter()
            .any(|name| name == "f1" || name == "effort_share")
    );
    let request = |variable: &str, counts: [usize; 3]| {
        json!({
            "state": { "force_n": [100, 50, 0] }, "variable": variable,
            "from_mm": [-60, -60, 0], "to_mm": [60, 60, 0], "counts": counts,
        })
    };
    let (code, found) = served.post("map", &request("deflection", [7, 5, 1]));
    assert_eq!(code, 200, "{found}");
    let values = numbers(&found["values"]);
    assert_eq!(values.len(), 35);
    let line = "map orthoglide --x -60 60 7 --y -60 60 5 --z 0 --force 100 50 0 --variables deflection --json";
    let wanted = said(here.path(), line);
    let figure = wanted["figures"].as_array().expect("a list").iter();
    let figure = figure.clone().find(|f| f["name"] == "deflection");
    let figure = figure.expect("a figure");
    let least = values.iter().copied().reduce(kinetostat::number::smaller);
    let most = values.iter().copied().fold(0.0, kinetostat::number::larger);
    assert_eq!(figure["least"]["value"], json!(least));
    assert_eq!(figure["most"]["value"], json!(most));
    // x runs fastest, and one place is the state there.
    let place = figure["most"]["position_mm"].clone();
    let at = json!({ "at_mm": place, "force_n": [100, 50, 0] });
    let displacement = numbers(&served.state(&at).1["displacement_mm"]);
    let size = displacement.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!((1e-3 * size - most).abs() < 1e-12, "{size} {most}");
    let at_most = values.iter().position(|x| *x == most).expect("a place");
    let place = numbers(&place);
    let index = [at_most % 7, at_most / 7].map(|i| i as f64);
    assert_eq!(
        place[..2],
        [-60.0 + 20.0 * index[0], -60.0 + 30.0 * index[1]]
    );
    for wrong in [
        request("nonsense", [2, 2, 1]),
        request("deflection", [0, 2, 1]),
        request("deflection", [2000, 2000, 1]),
    ] {
        assert_eq!(served.post("map", &wrong).0, 422, "{wrong}");
    }
    // Where the machine cannot be there is no number.
    let far = json!({ "state": {}, "variable": "stiffness_x", "from_mm": [0, 0, 0], "to_mm": [5000, 0, 0], "counts": [2, 1, 1] });
    let (_, found) = served.post("map", &far);
    assert!(
        found["values"][0].is_number() && found["values"][1].is_null(),
        "{found}"
    );
}

#[test]
fn responses_and_lobes_are_those_of_the_commands() {
    let here = here();
    let served = Served::of(here.path(), &["heavy_6r"]);
    let state = json!({ "force_n": [200, 0, 0] });
    let request =
        json!({ "state": state, "frequencies_hz": [5, 80], "count": 16, "damping_ratio": 0.03 });
    let (code, found) = served.post("response", &request);
    assert_eq!(code, 200, "{found}");
    let wanted = said(
        here.path(),
        "frf heavy_6r --force 200 0 0 --damping 0.03 --frequencies 5 80 16 --json",
    );
    assert_eq!(found["frequencies_hz"], wanted["frequencies_hz"]);
    for axis in 0..3 {
        let curve = &wanted["curves"][axis];
        let [re, im] = ["real", "imaginary"].map(|part| numbers(&curve[part]));
        for (k, own) in numbers(&found["um_per_n"][axis]).into_iter().enumerate() {
            let wanted = 1e6 * re[k].hypot(im[k]);
            assert!((own - wanted).abs() <= 1e-9 * wanted, "{own} {wanted}");
        }
    }
    let request = json!({
        "state": state, "speed_rpm": [1000, 6000], "speeds": 6, "depth_mm": 5, "teeth": 2, "immersion": 0.5, "up": true,
        "feed_direction": [1, 0, 0], "coefficients_n_per_mm2": [800, 240, 0], "damping_ratio": 0.03,
    });
    let (code, found) = served.post("lobes", &request);
    assert_eq!(code, 200, "{found}");
    let wanted = said(
        here.path(),
        "lobes heavy_6r --force 200 0 0 --damping 0.03 --teeth 2 --immersion 0.5 --up --coefficients-n-per-mm2 800 240 0 --rpm 1000 6000 6 --json",
    );
    let points = |v: &Value| v["points"].as_array().cloned().expect("a list");
    assert_eq!(points(&found).len(), 6);
    for (own, wanted) in points(&found).iter().zip(points(&wanted)) {
        assert_eq!(own["kind"], wanted["kind"]);
        // The command goes to the place of the tool, the page to the joints.
        for key in ["speed_rpm", "limit_mm", "chatter_hz"] {
            match (own[key].as_f64(), wanted[key].as_f64()) {
                (Some(own), Some(wanted)) => assert!((own - wanted).abs() < 1e-9 * wanted, "{key}"),
                (own, wanted) => assert_eq!(own, wanted, "{key}"),
            }
        }
    }
    let (_, undamped) = served.post(
        "response",
        &json!({ "state": {}, "frequencies_hz": [1, 2], "count": 2 }),
    );
    // As frf does it: without damping, where nobody states one.
    assert_eq!(undamped["damping"], "none", "{undamped}");
    for (question, key, value) in [
        ("response", "count", json!(1)),
        ("response", "frequencies_hz", json!([80, 5])),
        ("lobes", "speeds", json!(1e9)),
        ("lobes", "teeth", json!(0)),
    ] {
        let mut wrong = request.clone();
        if question == "response" {
            wrong = json!({ "state": {}, "frequencies_hz": [5, 80], "count": 16, "damping_ratio": 0.03 });
        }
        wrong[key] = value;
        assert_eq!(served.post(question, &wrong).0, 422, "{wrong}");
    }
}

#[test]
fn absurd_questions_are_answered_in_words() {
    let here = here();
    let served = Served::of(here.path(), &["orthoglide"]);
    for (request, code) in [
        (json!({ "at_mm": [1000, 0, 0] }), "unreachable"),
        (
            json!({ "at_mm": [0, 0, 0], "actuators": [0, 0, 0] }),
            "conflict",
        ),
        (json!({ "actuators": [0, 0] }), "value"),
        (json!({ "actuators": [1e300, 0, 0] }), "value"),
        (json!({ "force_n": [1e300, 0, 0] }), "value"),
        (json!({ "place": 0 }), "value"),
        (json!({ "place": 0, "force_n": [1, 0, 0] }), "conflict"),
        (json!({ "force": [1, 0, 0] }), "value"),
        (json!([1, 2]), "value"),
        (json!([null, null]), "value"),
    ] {
        let (status, answer) = served.state(&request);
        assert_eq!(status, 422, "{request}");
        assert_eq!(answer["error"]["code"], code, "{request}: {answer}");
    }
    // No equilibrium is a finding, and the machine is shown as it is commanded.
    let (status, answer) = served.state(&json!({ "force_n": [0, 0, -1e8] }));
    assert_eq!(status, 200);
    assert!(
        answer["finding"].is_string() || answer["stable"] == false,
        "{}",
        answer["figures"]
    );
    assert!(answer["scene"]["bars"].is_array());
}

/// Results in a page without a server.
fn results_in(page: &str) -> Value {
    let data = page.split_once("<script id=\"kinetostat-data\" type=\"application/json\">");
    let data = data.expect("results").1.split_once("</script>");
    serde_json::from_str(data.expect("an end").0).expect("JSON")
}

#[test]
fn a_report_holds_the_machine_at_its_largest_errors() {
    let here = here();
    let here = here.path();
    run(here, &["demo"]).answered();
    let report = std::fs::read_to_string(here.join("kinetostat-demo/report.html")).expect("a page");
    let frame = report.split_once("sandbox=\"allow-scripts\" loading=\"lazy\" srcdoc=\"");
    let (before, frame) = frame.expect("a frame");
    // Outside of its frame the report runs no script, and nothing in it may reach a network.
    assert!(before.contains("default-src 'none'"));
    let (frame, after) = frame.split_once('"').expect("an end");
    assert!(!before.contains("<script") && !after.contains("<script"));
    let escaped = [
        ("&quot;", "\""),
        ("&#x27;", "'"),
        ("&#x2f;", "/"),
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&amp;", "&"),
    ];
    let page = escaped
        .iter()
        .fold(frame.to_owned(), |page, (from, to)| page.replace(from, to));
    let data = results_in(&page);
    let places = data["path"]["places"].as_array().expect("a list");
    for key in ["error_before_mm", "error_after_mm"] {
        let error = |place: usize| places[place][key].as_f64().expect("a number");
        let worst = (0..places.len()).max_by(|a, b| error(*a).total_cmp(&error(*b)));
        let states = data["states"].as_array().expect("a list");
        assert!(
            states
                .iter()
                .any(|state| state["place"].as_u64() == worst.map(|w| w as u64)),
            "{key}"
        );
    }
    // On paper there is a picture.
    assert!(after.contains("src=\"data:image/svg+xml,"));
    assert!(report.len() < 3_000_000, "{} bytes", report.len());
}

#[test]
fn an_exported_page_holds_machine_path_and_states() {
    let here = here();
    let here = here.path();
    run(here, &["demo"]).answered();
    let folder = here.join("kinetostat-demo");
    let words = ["view", "job.toml", "--export", "page.html"];
    run(&folder, &words).answered();
    let page = std::fs::read_to_string(folder.join("page.html")).expect("a page");
    let data = results_in(&page);
    let places = data["path"]["places"].as_array().expect("a list");
    assert!(places.len() > 100, "{}", places.len());
    let most = |key: &str| {
        let each = places.iter().map(|p| p[key].as_f64().expect("a number"));
        each.fold(0.0, kinetostat::number::larger)
    };
    // README's figures of the demo.
    assert!(
        (most("error_before_mm") - 0.778).abs() < 2e-3,
        "{}",
        most("error_before_mm")
    );
    assert!(most("error_after_mm") < 1e-3, "{}", most("error_after_mm"));
    let result = std::fs::read_to_string(folder.join("result.json")).expect("a result");
    let result: Value = serde_json::from_str(&result).expect("JSON");
    let whole = result["summary"]["feed_time_before_s"]
        .as_f64()
        .expect("a time");
    let times: Vec<f64> = places
        .iter()
        .map(|p| p["time_s"].as_f64().expect("a time"))
        .collect();
    assert!(times.is_sorted());
    let last = times.last().expect("a place");
    assert!((0.99 * whole..=whole).contains(last), "{last} of {whole} s");
    let states = data["states"].as_array().expect("a list");
    assert!((20..=80).contains(&states.len()), "{}", states.len());
    assert!(
        states
            .iter()
            .all(|s| s["state"]["deflected"]["bars"].is_array())
    );
    // The machine stands where the program has the tool, not where the compensated one commands it.
    for state in states {
        let place = state["place"].as_u64().expect("an index") as usize;
        let wanted = places[place]["position_mm"].as_array().expect("a list");
        let scene = &state["state"]["scene"]["tool"]["position_mm"];
        let last = state["state"]["scene"]["bars"]
            .as_array()
            .and_then(|bars| bars.last().cloned());
        for k in 0..3 {
            let apart = scene[k].as_f64().expect("mm") - wanted[k].as_f64().expect("mm");
            assert!(apart.abs() < 1e-6, "place {place}: {apart} mm, {last:?}");
        }
    }
    assert!(
        data["path"]["text"]
            .as_str()
            .is_some_and(|text| text.contains("G3"))
    );
    // Not over a file that is there.
    assert_eq!(run(&folder, &words).code, 1);
    assert!(page.len() < 7_000_000, "{} bytes", page.len());
}

#[test]
fn files_that_are_dropped_are_shown() {
    let here = here();
    run(here.path(), &["demo"]).answered();
    let folder = here.path().join("kinetostat-demo");
    let file = |name: &str| {
        let text = std::fs::read_to_string(folder.join(name)).expect("a file");
        json!({ "name": name, "text": text })
    };
    let elsewhere = tempfile::tempdir().expect("a directory");
    let served = Served::of(elsewhere.path(), &["heavy_6r"]);
    let open = |files: &[Value]| served.post("open", &json!({ "files": files }));
    // A job without its program: what is missing is named as the job names it.
    let (code, refused) = open(&[file("job.toml")]);
    let message = refused["error"]["message"].as_str().expect("words");
    assert_eq!(code, 422);
    assert!(
        message.contains("'original.ngc'") && !message.contains("tmp"),
        "{message}"
    );
    assert_eq!(
        served.post("machine", &json!({})).1["actuators"]
            .as_array()
            .map(Vec::len),
        Some(6)
    );
    let (code, opened) = open(&[file("original.ngc"), file("model.toml"), file("job.toml")]);
    assert_eq!((code, opened), (200, Value::Null));
    let (_, machine) = served.post("machine", &json!({}));
    assert_eq!(
        (&machine["source"], &machine["has_path"]),
        (&json!("job.toml"), &json!(true))
    );
    let (_, path) = served.post("path", &json!({}));
    let most = path["places"].as_array().expect("a list").iter();
    let most = most.map(|p| p["error_before_mm"].as_f64().expect("a number"));
    let most = most.fold(0.0, kinetostat::number::larger);
    assert!((most - 0.778).abs() < 2e-3, "{most}");
    let outside = json!({ "name": "../up.toml", "text": "" });
    for (files, code) in [
        (vec![file("original.ngc")], "missing"),
        (vec![outside], "value"),
        (
            vec![json!({ "name": "model.toml", "text": "schema = 1\n[mechanism]\n" })],
            "model_file",
        ),
    ] {
        let (status, refused) = open(&files);
        assert_eq!(
            (status, &refused["error"]["code"]),
            (422, &json!(code)),
            "{refused}"
        );
    }
    assert!(!elsewhere.path().join("../up.toml").exists());
}

#[test]
fn the_stock_is_removed_along_the_program() {
    let here = here();
    let job = JOB_OF_A_SLOT;
    std::fs::write(here.path().join("slot.ngc"), SLOT).expect("written");
    std::fs::write(here.path().join("job.toml"), job).expect("written");
    let served = Served::of(here.path(), &["job.toml"]);
    let (_, path) = served.post("path", &json!({}));
    assert_eq!(path["has_stock"], true);
    let boxes = path["boxes"].as_array().expect("a list");
    let kinds: Vec<_> = boxes
        .iter()
        .map(|own| own["kind"].as_str().unwrap_or(""))
        .collect();
    assert_eq!(kinds, ["stock", "part", "obstacle"]);
    assert_eq!(boxes[2]["corner_mm"], json!([-50.0, -50.0, -300.0]));
    let places = path["places"].as_array().expect("a list").len();
    let cut = |place: usize| {
        let (code, stock) = served.post("stock", &json!({ "place": place }));
        assert_eq!(code, 200, "{stock}");
        let heights = numbers(&stock["heights"]);
        let counts = numbers(&stock["counts"]);
        assert_eq!(heights.len() as f64, counts[0] * counts[1]);
        heights
            .into_iter()
            .filter(|h| (h - 8.0).abs() < 1e-3)
            .count()
    };
    // 2 mm of 10 are cut away, the more the farther the tool has gone; and back again.
    let (early, late) = (cut(places / 3), cut(places - 1));
    assert!(0 < early && early < late, "{early} {late}");
    assert_eq!(cut(places / 3), early);
    assert_eq!(served.post("stock", &json!({ "place": places })).0, 422);
}

const SLOT: &str = "\
G21 G90
S10000 M3
G0 X-12 Y0 Z5
G1 Z-2 F600
G1 X40
G0 Z5
M2
";

const JOB_OF_A_SLOT: &str = "\
schema = 1
model = \"orthoglide\"
program = \"slot.ngc\"
[placement]
part_origin_mm = [0, 0, 100]
[tool]
length_mm = 60
cutter = { shape = \"flat\", diameter_mm = 10, teeth = 2, helix_deg = 30, flute_length_mm = 18 }
[material]
name = \"AlMg4.5Mn\"
[stock]
block_mm = [[-5, -10, -10], [40, 10, 0]]
[place]
x_mm = [-5, 5]
part_box_mm = [[-5, -10, -10], [40, 10, 0]]
obstacles = [{ name = \"vice\", from_mm = [-50, -50, -300], to_mm = [50, 50, -200] }]
";

#[test]
fn places_of_a_path_have_loads_and_chatter() {
    let here = here();
    let here = here.path();
    std::fs::write(here.join("slot.ngc"), SLOT).expect("written");
    // On the arm, with damping, chatter is judged.
    let on_arm = JOB_OF_A_SLOT
        .replace("orthoglide", "heavy_6r")
        .replace("[0, 0, 100]", "[1450, 70, 500]")
        .replace(
            "[place]\nx_mm = [-5, 5]",
            "[load]\nweight = \"all\"\n[chatter]\ndamping_ratio = 0.03\n[place]\nx_mm = [-5, 5]",
        );
    std::fs::write(here.join("job.toml"), on_arm).expect("written");
    let served = Served::of(here, &["job.toml"]);
    let (_, path) = served.post("path", &json!({}));
    let places = path["places"].as_array().expect("a list");
    let words = ["compensate", "job.toml", "--json"];
    let said = run(here, &words);
    let said: Value = serde_json::from_str(&said.out).unwrap_or_else(|_| panic!("{}", said.err));
    let judged = said["chatter"]["places"].as_array().expect("a list");
    let mut seen = 0;
    for place in places {
        assert_eq!(numbers(&place["drives"]).len(), 6);
        let path_mm = place["path_mm"].as_f64().expect("a number");
        let own = judged.iter().find(|own| {
            let range = numbers(&own["path_mm"]);
            own["chatters"].is_boolean() && range[0] <= path_mm && path_mm <= range[1]
        });
        let wanted = own.map(|own| {
            let limit = own["limit_mm"].as_f64().or(own["looked_up_to_mm"].as_f64());
            own["depth_mm"].as_f64().expect("a depth") / limit.expect("a limit")
        });
        match (place["depth_by_limit"].as_f64(), wanted) {
            (Some(own), Some(wanted)) => {
                assert!((own - wanted).abs() < 1e-9 * wanted, "{own} {wanted}");
                seen += 1;
            }
            (own, wanted) => assert_eq!(own, wanted),
        }
    }
    assert!(seen > 10, "{seen}");
}
