//! The short form of `cargo xtask fuzz`: the same cases in every run.

#[path = "../fuzz/mod.rs"]
pub(crate) mod fuzz;

#[test]
fn random_chains_through_every_question() {
    let (count, largest) = (300, 16);
    let mut all = fuzz::Outcome::default();
    let mut faults = Vec::new();
    for seed in 0..count {
        match fuzz::run(seed, largest) {
            Ok(outcome) => all.add(outcome),
            Err(fault) => faults.push(format!("{fault}\n{}", fuzz::describe(seed, largest))),
        }
    }
    println!("{all:?}");
    let figure = serde_json::json!({
        "name": "fuzz: random chains without panic or NaN, short form of cargo xtask fuzz",
        "measured": faults.len(),
        "asked": "exactly 0",
        "unit": format!("faults in {count} cases"),
        "holds": faults.is_empty(),
    });
    println!("figure {figure}");
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(all.solved > 100, "{all:?}");
}

/// The checks are worth something only if they see what is wrong.
#[test]
fn a_coordinate_that_is_off_is_noticed() {
    let seen: Vec<bool> = (0..400).filter_map(fuzz::notices).collect();
    let missed = seen.iter().filter(|s| !**s).count();
    println!("{missed} of {} missed", seen.len());
    assert!(
        seen.len() >= 20 && missed * 20 <= seen.len(),
        "{missed} of {}",
        seen.len()
    );
}

/// Seeds of long runs that found a fault once: rods of few segments that hardly stretch, and a soft axis beside
/// five stiff ones.
#[test]
fn what_long_runs_found_stays_mended() {
    let seeds = [
        779537, 777133, 778997, 779023, 779399, 788367, 789785, 790650, 791650, 792193, 792756,
        792832, 780182, 20262171, 20262762, 20263179, 20270613, 20271711, 20272639, 20272839,
        779901, 791521, 31429514, 31416123, 31417971, 31418205, 31418997, 31421004, 31428840,
        52003246, 52006057, 52006233, 52016067, 73026457, 90698, 91600, 94010, 95072, 95906,
        73025895, 84001339, 84001915, 84002485, 84003457, 84003631, 84004951, 84006097, 84006811,
        84009073, 84011305, 84011539, 84012337, 84014329, 84015487, 84015811, 84018619, 84019141,
        84020293, 84020485, 84020557, 84001443, 85001140, 85009309, 85014120,
    ];
    let faults: Vec<String> = seeds
        .into_iter()
        .filter_map(|seed| fuzz::run(seed, 40).err())
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
