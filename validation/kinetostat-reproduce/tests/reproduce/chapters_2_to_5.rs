//! Chapters 2 to 5 against numbers of independent programs: computed there
//! (energy minimisation, high-precision Newton) and held here digit by digit.

use kinetostat_reproduce::{Entry, Item, Status, one};

fn entry(id: &str) -> Entry {
    one(id).unwrap_or_else(|e| panic!("{e}"))
}

fn item<'e>(entry: &'e Entry, name: &str) -> &'e Item {
    let found = entry.items.iter().find(|item| item.name == name);
    found.unwrap_or_else(|| panic!("{} has no '{name}'", entry.id))
}

fn computed(entry: &Entry, name: &str) -> f64 {
    item(entry, name).computed.expect(name)
}

/// Half a unit of the last digit of a number as written.
fn half_digit(written: &str) -> f64 {
    let (mantissa, exponent) = written.split_once('e').unwrap_or((written, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, d)| d.len() as i32);
    0.5 * 10_f64.powi(exponent.parse::<i32>().expect("exponent") - decimals)
}

/// The computed number rounds to the reference as written. Reference numbers are roundings
/// themselves, so a last digit may differ where they were rounded twice.
#[track_caller]
fn holds(entry: &Entry, name: &str, reference: &str) {
    let (found, expected) = (computed(entry, name), reference.parse::<f64>().expect(name));
    let most = 1.1 * half_digit(reference);
    assert!(
        (found - expected).abs() <= most,
        "{}, {name}: {found} instead of {reference}",
        entry.id
    );
}

fn rows(table: &str) -> impl Iterator<Item = Vec<&str>> {
    table.lines().map(|line| line.split_whitespace().collect())
}

/// Thickness and width in mm, N at 1000, 1500 and 2000 m/min: Monel 400, then Al Mg 4.5 Mn.
const TABLE_2_3: &str = "\
0.2 8 6965.1043 6770.1960 6635.2231
0.2 16 13930.2087 13540.3919 13270.4461
1.0 8 25650.3521 24932.5640 24435.5001
1.0 16 51300.7042 49865.1280 48871.0001
0.2 8 2228.4746 2166.1139 2122.9296
0.2 16 4456.9491 4332.2278 4245.8591
1.0 8 7695.1056 7479.7692 7330.6500
1.0 16 15390.2112 14959.5384 14661.3000";

#[test]
fn cutting_forces_of_table_2_3() {
    let entry = entry("table-2.3");
    for (k, row) in rows(TABLE_2_3).enumerate() {
        let material = if k < 4 { "Monel 400" } else { "Al Mg 4.5 Mn" };
        let thickness: f64 = row[0].parse().expect("thickness");
        for (speed, force) in ["1000", "1500", "2000"].iter().zip(&row[2..]) {
            let name = format!("{material}, {thickness} x {} mm, {speed} m/min", row[1]);
            let newtons: f64 = force.parse().expect("force");
            let found = 1e3 * computed(&entry, &name);
            assert!((found - newtons).abs() < 6e-5, "{name}: {found}");
        }
    }
}

/// `k_c1.1` in N/mm^2 and `m_c` of Table 2.2; every number of Tables 2.1 and 2.2 agrees with its print.
#[test]
fn materials_and_factors_of_tables_2_1_and_2_2() {
    let materials = entry("table-2.2");
    for (name, specific, exponent) in [
        ("Monel 400", 2600.0, 0.19),
        ("Inconell 718", 2088.0, 0.29),
        ("Ti Al 6 V 4", 1370.0, 0.21),
        ("Al Mg 4.5 Mn", 780.0, 0.23),
    ] {
        let found = |of: &str| computed(&materials, &format!("{name}: {of}"));
        assert!((found("k_c1.1") - specific).abs() < 1e-9, "{name}");
        assert!((found("m_c") - exponent).abs() < 1e-12, "{name}");
        let at_0_2 = specific * 0.2_f64.powf(-exponent);
        let by_2_2 = found("k_c at h = 0.2 mm, by equation 2.2");
        assert!((by_2_2 - at_0_2).abs() < 1e-9 * at_0_2, "{name}: {by_2_2}");
    }
    let factors = entry("table-2.1");
    for (name, value) in [
        ("K_PRO, milling with coefficients of turning tests", 1.3),
        ("K_V at 50 m/min", 1.111_869),
        ("K_V at 1000 m/min", 0.850_901),
        ("K_gamma, steel, rake of 6 degrees", 1.018),
        ("K_gamma, cast iron, rake of -6 degrees", 1.102),
        ("K_CM, ceramic", 0.925),
        ("K_TW, worn edge", 1.4),
        ("K_CL, emulsion", 0.9),
        ("K_WS, turning inside", 1.2),
    ] {
        let found = computed(&factors, name);
        assert!((found - value).abs() < 6e-6, "{name}: {found}");
    }
    for entry in [&materials, &factors] {
        for item in &entry.items {
            let agrees = matches!(item.status, Status::Agrees | Status::NoPrint);
            assert!(agrees, "{}, {}: {item:?}", entry.id, item.name);
        }
    }
}

/// Curves of chapter 2 against their closed forms.
#[test]
fn curves_of_chapter_2() {
    // K_V: 2.023/v^0.153 up to 100 m/min, 1.380/v^0.07 above.
    let speed = entry("fig-2.2");
    let at_100 = 2.023 * 100.0_f64.powf(-0.153);
    for (v, factor) in [
        (20.0_f64, 2.023 * 20.0_f64.powf(-0.153)),
        (1000.0, 1.38 * 1000.0_f64.powf(-0.07)),
    ] {
        let name = format!("force at {v} m/min, as a share of that at 100 m/min");
        assert!(
            (computed(&speed, &name) - factor / at_100).abs() < 1e-9,
            "{name}"
        );
    }
    for material in ["Monel 400", "Al Mg 4.5 Mn"] {
        let saved = computed(
            &speed,
            &format!("{material}: force saved from 1000 to 2000 m/min"),
        );
        assert!(
            (saved - 100.0 * (1.0 - 2.0_f64.powf(-0.07))).abs() < 1e-9,
            "{saved}"
        );
    }
    // A slot: with straight teeth one cuts at a time. By midpoints over half a turn, with the parts that the library has.
    let turn = entry("fig-2.3");
    let tangential = item(&turn, "straight teeth: largest tangential force");
    assert_eq!(tangential.status, Status::Agrees);
    let n = 200_000;
    let (mut across, mut torque) = (0.0, 0.0);
    for k in 0..n {
        let phi = std::f64::consts::PI * (f64::from(k) + 0.5) / f64::from(n);
        let force = 8.0 * 780.0 * (0.2 * phi.sin()).powf(0.77);
        // Two teeth, each half a turn in the cut; the radial part is 0.4 of the tangential one.
        across += force * (phi.sin() - 0.4 * phi.cos()) / f64::from(n);
        torque += 1e-3 * 10.0 * force / f64::from(n);
    }
    for teeth in ["straight teeth", "helix of 30 degrees"] {
        let found = computed(
            &turn,
            &format!("{teeth}: mean force on the tool across the feed"),
        );
        assert!((found / across - 1.0).abs() < 1e-6, "{found} {across}");
        let found = computed(&turn, &format!("{teeth}: mean torque"));
        assert!((found / torque - 1.0).abs() < 1e-6, "{found} {torque}");
        let share = computed(
            &turn,
            &format!("{teeth}: largest force, as a share of 2 k_c b h"),
        );
        assert!(share > 0.3 && share < 1.0, "{share}");
    }
    // The law of thin and of thick chips, and how closely it follows a power.
    let rational = entry("eq-2.3");
    let [a_1, a_2, a_3] = [
        "a_1, slope for thin chips, per width",
        "a_2, per width",
        "a_3",
    ]
    .map(|name| computed(&rational, name));
    let mut worst = kinetostat_testing::Worst::new();
    for k in 0..=1000 {
        let h = 0.02 * 50.0_f64.powf(f64::from(k) / 1000.0);
        worst.add((a_1 * h + a_2 * h * h) / (1.0 + a_3 * h) / (780.0 * h.powf(0.77)) - 1.0);
    }
    let name = "largest difference of equations 2.3 and 2.2, chips of 0.02 to 1 mm";
    let said = computed(&rational, name);
    assert!(
        (said - 100.0 * worst.of(1001)).abs() < 0.02,
        "{said} {worst}"
    );
    assert!(said < 10.0, "{said}");
    for id in ["eq-2.2", "eq-2.3"] {
        let entry = entry(id);
        assert!(!entry.plots.is_empty());
        for item in &entry.items {
            let agrees = matches!(item.status, Status::Agrees | Status::NoPrint);
            assert!(agrees, "{id}, {}: {item:?}", item.name);
        }
    }
    // Half the chip.
    let text = entry("text-2.2");
    let name =
        "force of a tooth, Al Mg 4.5 Mn, at twice the spindle speed and the same feed, as a share";
    assert!((computed(&text, name) - 0.5_f64.powf(0.77)).abs() < 1e-12);
    // The compliances of six joints add up to the trace of the rotational block: its largest eigenvalue is a third of it or more.
    let joints: f64 = [1.4e6, 3.31e6, 2.46e6, 3.33e5, 3.03e5, 4.23e5]
        .map(f64::recip)
        .iter()
        .sum();
    let sum = (10.0 * joints).to_degrees();
    let [least, most] = ["least", "most"]
        .map(|which| computed(&text, &format!("turn of a KUKA-240 under 10 N m, {which}")));
    assert!(most >= sum / 3.0 && most <= sum, "{most} {sum}");
    assert!(least > 0.0 && least <= sum / 3.0, "{least} {sum}");
    assert!((300.0..3000.0).contains(&(1.6 / most)), "{most}");
}

#[test]
fn beams_and_platforms_of_chapter_3() {
    let beam = entry("eq-3.26");
    for (name, value) in [
        ("K11", 1.8e8),
        ("K22", 514_285.714_286),
        ("K33", 220_408.163_265),
        ("K44", 10_285.714_285_7),
        ("K55", 36_000.0),
        ("K66", 84_000.0),
        ("K35", 77_142.857_142_9),
        ("K26", -180_000.0),
    ] {
        let found = computed(&beam, name);
        assert!(
            (found - value).abs() < 1e-9 * value.abs(),
            "{name}: {found}"
        );
    }
    let cases = [
        (
            "eq-3.34",
            [
                ("K11", 300_000.0),
                ("K22", 300_000.0),
                ("K33", 5_400_000.0),
                ("K44", 243_000.0),
                ("K55", 243_000.0),
                ("K66", 0.0),
                ("K15", 270_000.0),
                ("K24", -270_000.0),
            ],
            3.0,
        ),
        (
            "eq-3.35",
            [
                ("K11", 1_036_363.636_36),
                ("K22", 1_036_363.636_36),
                ("K33", 3_927_272.727_27),
                ("K44", 176_727.272_727),
                ("K55", 176_727.272_727),
                ("K66", 184_090.909_091),
                ("K15", -49_090.909_090_9),
                ("K24", 49_090.909_090_9),
            ],
            6.0,
        ),
    ];
    for (id, entries, rank) in cases {
        let e = entry(id);
        for (name, value) in entries {
            let found = computed(&e, name);
            assert!((found - value).abs() < 1e-5, "{id} {name}: {found}");
        }
        assert_eq!(computed(&e, "rank"), rank, "{id}");
    }
    for id in ["table-3.2", "table-3.3"] {
        let e = entry(id);
        for rank in e.items.iter().filter(|i| i.name.ends_with(": rank")) {
            assert_eq!(rank.computed, Some(5.0), "{id} {}", rank.name);
        }
    }
    for id in ["table-3.1", "table-3.2", "table-3.3"] {
        for rule in entry(id)
            .items
            .iter()
            .filter(|i| i.name.contains("elimination"))
        {
            assert!(rule.computed.expect("share") < 1e-12, "{id} {}", rule.name);
        }
    }
}

/// G/G*, dx, K_x, true S_c.
const TABLE_5_2: &str = "\
0 -0.05 6.694450654 -0.51171751
0 0 14.92820323 -0.66666667
0 0.05 107.1714969 -1.290774
0.5 -0.05 3.36128926 -0.25693379
0.5 0 7.464101615 -0.33333333
0.5 0.05 53.87815179 -0.6489087
1.0 -0.05 0.02812786612 -0.0021500676
1.0 0 0 0
1.0 0.05 0.5848066436 -0.0070434139
1.5 -0.05 -3.305033528 0.25263365
1.5 0 -7.464101615 0.33333333
1.5 0.05 -52.7085385 0.63482188";

#[test]
fn stiffness_and_shape_of_table_5_2() {
    let e = entry("table-5.2");
    for row in rows(TABLE_5_2) {
        let (g, dx): (f64, f64) = (row[0].parse().expect("g"), row[1].parse().expect("dx"));
        holds(&e, &format!("K, G = {g} G*, dx = {dx} L"), row[2]);
        holds(&e, &format!("S_c, G = {g} G*, dx = {dx} L"), row[3]);
    }
}

/// dx, then F_x and K_x at G/G* = 0, 0.5, 1, 1.5.
const FIGURE_4_3: &str = "\
-0.4 -1.3579007 -1.6662337 -1.9745666 -2.2828996 1.1611601 0.67421806 0.18727599 -0.29966609
-0.3 -1.2268932 -1.5921527 -1.9574121 -2.3226715 1.4942426 0.82462045 0.15499834 -0.51462377
-0.2 -1.0476327 -1.4957144 -1.9437961 -2.3918777 2.1841488 1.1499429 0.11573713 -0.91846869
-0.1 -0.75340313 -1.3440609 -1.9347186 -2.5253763 4.0661149 2.0643905 0.062666098 -1.9390583
0.02 0.38449282 -0.77362309 -1.931739 -3.0898549 24.966337 12.492985 0.019632219 -12.45372
0.04 1.122448 -0.40387873 -1.9302055 -3.4565322 55.574615 27.88051 0.18640493 -27.5077
0.06 3.8036755 0.94522115 -1.9132332 -4.7716875 355.9 179.4221 2.944203 -173.5337";

/// G/G*, angle, dx, F_x where K_x vanishes with a change of sign.
const LIMITS_4_3: &str = "\
0.5 -0.6338719688 -0.320371039 -2.672437355
0.9 -0.3445619451 -0.0494046306 -2.292085823
0.95 -0.2694580716 -0.00402104422 -2.210681752
1 -0.1307874376 0.0510673625 -2.085317355
1.005 -0.1012454059 0.0579064685 -2.063145828
1.005 0.1422197071 0.0479559718 -1.945908995
1.005 0.3522324213 -0.0546418919 -1.939607473
1.02 0.4301883831 -0.114077248 -1.958224981
1.05 0.5116302756 -0.187956683 -1.988529081
1.1 0.5957045028 -0.276344826 -2.030209837
1.5 0.9032153489 -0.693675473 -2.245611734";

#[test]
fn curves_of_figure_4_3() {
    let e = entry("fig-4.3");
    for row in rows(FIGURE_4_3) {
        for (k, g) in ["0", "0.5", "1", "1.5"].iter().enumerate() {
            holds(
                &e,
                &format!("F_x, dx = {} L, G = {g} G*", row[0]),
                row[1 + k],
            );
            holds(
                &e,
                &format!("K_x, dx = {} L, G = {g} G*", row[0]),
                row[5 + k],
            );
        }
    }
    let of = |what: &str| -> Vec<&Item> {
        let start = format!("{what} at the limit point");
        e.items
            .iter()
            .filter(|i| i.name.starts_with(&start))
            .collect()
    };
    let (angles, places, forces) = (of("a"), of("dx"), of("F_x"));
    assert_eq!(
        angles.len(),
        rows(LIMITS_4_3).count(),
        "no limit point more or less"
    );
    for row in rows(LIMITS_4_3) {
        let g: f64 = row[0].parse().expect("g");
        let a: f64 = row[1].parse().expect("angle");
        let k = (0..angles.len())
            .find(|&k| {
                angles[k].name.ends_with(&format!("G = {g} G*"))
                    && (angles[k].computed.expect("angle") - a).abs() < 1e-8
            })
            .unwrap_or_else(|| panic!("no limit point at G = {g} G*, a = {a}"));
        let near = |item: &Item, written: &str| {
            let expected: f64 = written.parse().expect("number");
            let found = item.computed.expect("number");
            // A place between two rounded ones: half a digit more.
            assert!((found - expected).abs() < 1e-8, "{}: {found}", item.name);
        };
        near(places[k], row[2]);
        near(forces[k], row[3]);
    }
}

/// G/G*, dx, node y, F_x, K_xx, stable with the end held, and with x free.
const TABLE_4_6_2: &str = "\
0 -0.05 0.332059848 -0.466562542 6.6865303 yes yes
0 -0.05 -0.0558138838 -11.5042347 107.03798 no no
0 -0.05 -0.277685964 -3.95247246 -13.025878 yes no
0 0 0.258819045 0 13.1031674 yes yes
0 0.05 0.169711219 1.08631261 34.9160772 yes yes
0.5 -0.05 0.320528747 -1.17486288 3.82893158 yes yes
0.5 -0.05 -0.0291332205 -11.7382855 101.620169 no no
0.5 -0.05 -0.294797399 -3.00988625 -4.750592 yes no
0.5 0 0.240291385 -0.890746544 8.56480523 yes yes
0.5 0 -0.0625734445 -6.44010554 120.604171 no no
0.5 0 -0.181093188 -3.55760959 -28.4844902 yes no
0.5 0.05 0.133130014 0.000220914926 35.4558273 yes yes
1 -0.05 0.307819718 -1.93555766 0.102541188 yes yes
1 -0.05 -0.00377089379 -11.8154929 100.003569 no no
1 -0.05 -0.30941257 -2.17166073 0.592230381 yes yes
1 0 0.217119305 -1.92801064 0.266275245 yes yes
1 0 -0.00497392752 -6.81502933 100.023984 no no
1 0 -0.217474079 -2.14510657 0.39406621 yes yes
1 0.05 0.0326498911 -1.6911571 55.647624 yes yes
1.5 -0.05 0.293515333 -2.76559553 -5.0534236 yes no
1.5 -0.05 0.0215035817 -11.7510249 101.343891 no no
1.5 -0.05 -0.322344531 -1.4056792 4.40766084 yes yes
1.5 0 0.183254036 -3.28168368 -23.8408494 yes no
1.5 0 0.0509213565 -6.51473313 115.315614 no no
1.5 0 -0.241457546 -1.09132852 9.20935573 yes yes
1.5 0.05 -0.132601447 -0.152624747 37.2838169 yes yes
2 -0.05 0.276881175 -3.69433828 -12.8819489 yes no
2 -0.05 0.047876969 -11.5336727 106.269758 no no
2 -0.05 -0.334045631 -0.693788745 7.31006187 yes yes
2 0 -0.260418851 -0.193099914 13.8712314 yes yes
2 0.05 -0.170732964 0.943231422 36.2957185 yes yes";

#[test]
fn all_shapes_of_figure_4_5() {
    let e = entry("fig-4.5");
    let shapes = e
        .items
        .iter()
        .filter(|i| i.name.ends_with("node y"))
        .count();
    assert_eq!(shapes, 31);
    for row in rows(TABLE_4_6_2) {
        let (g, dx): (f64, f64) = (row[0].parse().expect("g"), row[1].parse().expect("dx"));
        let start = format!("G = {g} G*, dx = {dx} L, shape ");
        let y: f64 = row[2].parse().expect("y");
        let shape = e
            .items
            .iter()
            .find(|i| {
                i.name.starts_with(&start)
                    && i.name.ends_with(": node y")
                    && (i.computed.expect("y") - y).abs() < 1e-8
            })
            .unwrap_or_else(|| panic!("no shape with its node at {y}, {start}"));
        let label = shape.name.trim_end_matches(": node y");
        holds(&e, &format!("{label}: F_x"), row[3]);
        holds(&e, &format!("{label}: K_xx"), row[4]);
        let note = match (row[5], row[6]) {
            ("yes", "yes") => "stable",
            ("yes", _) => "stable with the end held, unstable under a dead force",
            _ => "unstable",
        };
        assert_eq!(shape.note, note, "{label}");
    }
}

/// G/G*, x, dx, node y, F_x.
const LIMITS_4_6_2: &str = "\
0 1.922272795 -0.0095788571 -0.137732345 -5.86836656
0.5 1.942925249 0.011073597 -0.111303931 -4.49506146
1 1.975281172 0.043429519 -0.0405154222 -2.32892263
1.5 1.945566931 0.013715278 0.103783052 -4.28099972
2 1.92463389 -0.0072177621 0.13138615 -5.66307168";

#[test]
fn limit_points_of_figure_4_4() {
    let e = entry("fig-4.4");
    for row in rows(LIMITS_4_6_2) {
        let g: f64 = row[0].parse().expect("g");
        for (k, what) in ["x", "dx", "node y", "F_x"].iter().enumerate() {
            let name = format!("{what} of the limit point with the end held, G = {g} G*");
            holds(&e, &name, row[1 + k]);
        }
    }
    holds(
        &e,
        "pitchfork of the flat chain without preload (a0 = 0): x",
        "1.979795897113",
    );
    // With the preload the same place is a limit point of the displacement, no fork.
    let name = "flat chain with preload: x of its displacement limit";
    let found = computed(&e, name);
    assert!((found - 1.979_795_897_113).abs() < 1e-8, "{name}: {found}");
    assert!(item(&e, name).note.contains("E_YYY"));
    holds(
        &e,
        "flat chain with preload: G = 4 a0/r that holds it there",
        "1.057884353",
    );
    holds(
        &e,
        "flat chain with preload: the same in units of G*",
        "1.021837818",
    );
    for (what, value) in [
        // Newton in 40 digits; the other programs stop at 1.01096193478.
        ("G/G*", "1.010961934781130"),
        ("node y", "0.216530824546"),
        ("F_x", "-1.953205835430"),
    ] {
        let name = format!("K_x = 0 of the upper shape at dx = 0: {what}");
        holds(&e, &name, value);
    }
}

/// Delta, then F, K, S_c of the stable and of the unstable shape, compression positive.
const FIGURE_5_7: &str = "\
0.02 1.003346724 0.16800862 -0.63113796 3.0100605 0.50607521 1.33337376
0.05 1.00841757 0.17005438 -0.63048508 3.025382921 0.51547901 1.33359004
0.1 1.017007305 0.17355415 -0.62942142 3.051564905 0.53197863 1.33438825
0.2 1.03472647 0.18091099 -0.62739680 3.106545759 0.56846556 1.33779500
0.5 1.092671476 0.20628159 -0.62240607 3.297581844 0.71664612 1.36684214
1 1.209199576 0.26360014 -0.62017787 3.766557031 1.25447 1.53049160
1.5 1.361344425 0.35182074 -0.63254394 4.810425213 3.6299101 2.13941471";

#[test]
fn curves_of_figure_5_7() {
    let e = entry("fig-5.7");
    for row in rows(FIGURE_5_7) {
        for (k, shape) in ["stable", "unstable"].iter().enumerate() {
            for (n, what) in ["F", "K", "S_c"].iter().enumerate() {
                let name = format!("{what} of the {shape} shape at Delta = {}", row[0]);
                holds(&e, &name, row[1 + 3 * k + n]);
            }
        }
    }
    for (mode, load) in [("arch", 1.0), ("zigzag", 3.0)] {
        let found = computed(&e, &format!("bifurcation load of the {mode}"));
        assert!((found - load).abs() < 1e-10, "{mode}: {found}");
    }
    for n in 2..=6 {
        let found = computed(&e, &format!("critical load of {n} equal links"));
        let exact = 2.0 * (1.0 - (std::f64::consts::PI / f64::from(n)).cos());
        assert!((found - exact).abs() < 1e-8, "{n} links: {found}");
    }
}

/// Delta, q, theta1, theta2 in degrees, F_x, K_xx, S_c, mu, stable.
const Z_CHAIN: &str = "\
0 9.8960906 -30.0 30.0 0 16.928203 -0.6666667 -0.0000000 yes
0 -9.8960906 30.0 -30.0 -6.09325071 -15.870556 3.3350597 6.0025896 no
0.05 12.277541 -37.446862 37.446862 -0.611210298 8.9670355 -0.2685125 0.5972313 yes
0.05 -12.277541 37.446862 -37.446862 -5.5357834 -7.8745773 2.9394497 5.4091745 no
0.1 14.23451 -43.692319 43.692319 -0.971876963 5.8550738 -0.0386414 0.9420378 yes
0.1 -14.23451 43.692319 -43.692319 -5.23066014 -4.7253694 2.7133769 5.0700654 no
0.115 18.34827 -48.654969 41.249934 -1.03430334 0.20335184 -0.0276281 0.9609886 yes
0.115 10.943235 -41.249934 48.654969 -1.03430334 0.20335184 -0.0254284 0.9609886 yes
0.115 14.764714 -45.408601 45.408601 -1.05525021 5.2797319 0.0136043 1.0204064 no
0.115 -14.764714 45.408601 -45.408601 -5.1643198 -4.138341 2.6625311 4.9937967 no
0.2 32.536503 -62.419012 27.612216 -1.05202636 0.21382344 -0.3495271 0.6153020 yes
0.2 -2.2702936 -27.612216 62.419012 -1.05202636 0.21382344 -0.2812119 0.6153020 yes
0.2 17.417073 -54.190361 54.190361 -1.41051127 3.3601066 0.2305607 1.3458410 no
0.2 -17.417073 54.190361 -54.190361 -4.90904012 -2.1475317 2.4559776 4.6839664 no
0.4 48.108858 -76.813879 13.390685 -1.09758209 0.24286948 -0.5312965 0.4614500 yes
0.4 -15.314337 -13.390685 76.813879 -1.09758209 0.24286948 -0.4338591 0.4614500 yes
0.4 22.147741 -71.085137 71.085137 -1.90206432 1.8955709 0.5078134 1.7617202 no
0.4 -22.147741 71.085137 -71.085137 -4.67980504 -0.47379966 2.2230032 4.3345048 no";

#[test]
fn all_shapes_of_figure_5_8() {
    let e = entry("fig-5.8");
    let shapes = e.items.iter().filter(|i| i.name.ends_with(": q")).count();
    assert_eq!(shapes, rows(Z_CHAIN).count());
    for row in rows(Z_CHAIN) {
        let q: f64 = row[1].parse().expect("q");
        let start = format!("Delta = {}, shape ", row[0]);
        let shape = e
            .items
            .iter()
            .find(|i| {
                i.name.starts_with(&start)
                    && i.name.ends_with(": q")
                    && (i.computed.expect("q") - q).abs() < 1e-5
            })
            .unwrap_or_else(|| panic!("no shape with q = {q}, {start}"));
        let label = shape.name.trim_end_matches(": q");
        assert_eq!(label.contains("(stable)"), row[8] == "yes", "{label}");
        for (k, what) in ["theta1", "theta2", "F_x", "K_x", "S_c"].iter().enumerate() {
            holds(&e, &format!("{label}: {what}"), row[2 + k]);
        }
        holds(
            &e,
            &format!("{label}: share mu of the way to buckling (stable below 1)"),
            row[7],
        );
    }
    holds(&e, "pitchfork: Delta", "0.110931613194");
    holds(&e, "pitchfork: x", "2.79838129798");
    holds(&e, "pitchfork: F_x", "-1.03347699957");
}

#[test]
fn cells_of_table_5_1() {
    let e = entry("table-5.1");
    for (cell, values) in [
        (
            "S stable, Delta = 0.2",
            ["-1.034726470", "0.1809109915", "-0.6273967980"],
        ),
        (
            "S unstable, Delta = 0.2",
            ["-3.106545759", "0.5684655621", "1.337795002"],
        ),
        ("Z stable, Delta = 0", ["0", "16.92820323", "-0.6666666667"]),
        (
            "Z unstable, Delta = 0",
            ["-6.093250712", "-15.87055613", "3.3350597"],
        ),
        (
            "Z unstable, Delta = 0, preload forgotten (th0 = 0)",
            ["-3.046625356", "0.52882355", "1.3341965"],
        ),
        (
            "Z stable, Delta = 0.2",
            ["-1.052026359", "0.2138234439", "-0.3495271307"],
        ),
        (
            "Z unstable, Delta = 0.2, true equilibrium (symmetric Z)",
            ["-1.410511269", "3.36010658", "0.23056066"],
        ),
        (
            "Z unstable, Delta = 0.2, true equilibrium (mirrored Z)",
            ["-4.909040118", "-2.147531682", "2.4559776"],
        ),
    ] {
        for (what, value) in ["F", "K_C", "S_c"].iter().zip(values) {
            holds(&e, &format!("{cell}: {what}"), value);
        }
    }
    holds(
        &e,
        "Z stable, Delta = 0.2: S_c of the mirror image",
        "-0.2812118576",
    );
    for (name, value) in [
        ("S stable, Delta = 0: eigenvalue 1 of S_c", "-0.813655"),
        ("S stable, Delta = 0: eigenvalue 2 of S_c", "-0.329203"),
        ("S unstable, Delta = 0: eigenvalue 1 of S_c", "-0.317587"),
        ("S unstable, Delta = 0: eigenvalue 2 of S_c", "0.674730"),
    ] {
        holds(&e, name, value);
    }
}

/// phi0, critical displacement / d0, force / (K L), force / (d0^3/sqrt 3), stiffness / K.
const TOGGLE: &str = "\
0.01 0.42264011 5.773502693e-7 1.00005 0.00030002
0.05 0.42240908 7.216878866e-5 1.001251 0.0075125177
0.1 0.42168614 0.0005773509122 1.0050153 0.030201139
0.2 0.41877921 0.004618885057 1.0202469 0.12327408
0.3 0.4138797 0.01558989109 1.0462661 0.28706675
0.5 0.39772456 0.07222211631 1.1351868 0.89533923
0.8 0.35497775 0.2972006174 1.3944597 3.1804667";

#[test]
fn the_toggle_frame_of_5_45() {
    let e = entry("eq-5.45");
    for row in rows(TOGGLE) {
        let at = format!("phi0 = {} rad", row[0]);
        holds(&e, &format!("critical displacement / d0, {at}"), row[1]);
        holds(&e, &format!("critical force, {at}"), row[2]);
        holds(
            &e,
            &format!("critical force / (K d0^3/(sqrt 3 L^2)), {at}"),
            row[3],
        );
        holds(&e, &format!("stiffness at rest, {at}"), row[4]);
    }
}

/// Two chains with one tool: energies by bisection on the condition of equilibrium of each chain, over the angle of its
/// first link, by hand.
#[test]
fn two_chains_with_one_tool_have_sixteen_shapes() {
    let e = entry("fig-5.2");
    let (first, second) = (
        [0.345088007019, 1.071449040000],
        [0.260292009868, 0.786737136213],
    );
    for (name, value) in [
        ("equilibria", 16.0),
        ("stable", 4.0),
        ("both chains stable: energy", first[0] + second[0]),
        ("both chains stable: shapes", 4.0),
        ("first chain unstable: energy", first[1] + second[0]),
        ("second chain unstable: energy", first[0] + second[1]),
        ("both chains unstable: energy", first[1] + second[1]),
        ("both chains unstable: shapes", 4.0),
        (
            "straight at rest, tool 100 mm between the feet: equilibria",
            16.0,
        ),
        (
            "straight at rest, tool 100 mm between the feet: stable",
            4.0,
        ),
    ] {
        let found = computed(&e, name);
        assert!((found - value).abs() < 1e-9, "{name}: {found}");
    }
}
