//! Random jobs over all commands along a program: one job has one verdict.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::time::{Duration, Instant};

use crate::common::{Said, run};

/// Numbers of a seed (SplitMix64), and the time for which cases are tried.
pub struct Random {
    state: u64,
    until: Instant,
    pub seed: u64,
}

impl Random {
    /// `KINETOSTAT_FUZZ_SECONDS` and `KINETOSTAT_FUZZ_SEED`; without them a few cases of seed 1.
    pub fn of_environment() -> Self {
        let read = |name: &str| std::env::var(name).ok()?.parse::<u64>().ok();
        let seed = read("KINETOSTAT_FUZZ_SEED").unwrap_or(1);
        let seconds = read("KINETOSTAT_FUZZ_SECONDS").unwrap_or(3);
        Self {
            state: seed,
            until: Instant::now() + Duration::from_secs(seconds),
            seed,
        }
    }

    pub fn below(&mut self, most: u64) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % most
    }

    pub fn one_of<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        let index = usize::try_from(self.below(all.len() as u64)).unwrap();
        &all[index]
    }

    pub fn for_a_while(&mut self, mut case: impl FnMut(&mut Self)) {
        let mut count = 0;
        while count == 0 || Instant::now() < self.until {
            case(self);
            count += 1;
        }
        eprintln!("seed {}: {count} cases", self.seed);
    }
}

const PARTS: [&str; 3] = [
    "G21 G90\nS8000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X40 F600\nG3 X50 Y10 I0 J10\nG0 Z5\nM30\n",
    "G21 G90\nT1 M6\nS8000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X30 F600\nG0 Z5\nT2 M6\nS6000 M3\nG0 X0 Y5\nG1 Z-2 F300\nG1 X30 F500\nG0 Z5\nM30\n",
    "G20 G90\nG0 X0 Y0 Z0.2\nG1 Z-0.04 F12\nG1 X1.5 F24\nG0 Z0.2\nM2\n",
];

/// Job and template of one random cell, and the language that is written.
fn job(random: &mut Random) -> (String, String, &'static str) {
    let mut side = |text: &str| match random.below(3) {
        0 => (text.to_owned(), String::new()),
        1 => (String::new(), text.to_owned()),
        _ => (text.to_owned(), text.to_owned()),
    };
    let tip = side("pose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\n");
    let stands = side("tool_orientation = { a_b_c_kuka_deg = [160, 0, 180] }\n");
    let (x, z) = *random.one_of(&[(1300, 800), (1250, 850), (1400, 700), (5000, 0)]);
    let shares = random.below(3);
    let origin = match shares {
        1 => String::new(),
        _ => format!("part_origin_mm = [{x}, 0, {z}]\n"),
    };
    let other = x + i32::from(random.below(8) == 0);
    let base = match shares {
        0 => String::new(),
        _ => format!("pose = {{ position_mm = [{other}, 0, {z}] }}\n"),
    };
    let to = *random.one_of(&["", "krl", "rapid", "ls"]);
    let robot = match to {
        "" => "[robot]\ntemplate = \"cell.toml\"\n".to_owned(),
        to => format!("[robot]\nto = \"{to}\"\ntemplate = \"cell.toml\"\n"),
    };
    let load = *random.one_of(&[
        "[load]\nweight = \"all\"\nforce_n = [60, 20, 100]\n",
        "[load]\nweight = \"all\"\nmilling = { radial_n = 60, tangential_n = -10, axial_n = -25 }\n",
        "[load]\nweight = \"all\"\nforce_n = [60, 0, 9000]\n",
    ]);
    let extra = *random.one_of(&[
        "",
        "",
        "[reading]\nblock_delete = \"skip\"\n",
        "[tolerances]\npath_um = 30\n",
        "[limits]\ncorrection_mm = 0.01\n",
    ]);
    let spindle = *random.one_of(&[
        "",
        "[spindle]\nclockwise = [\"A={rpm}\"]\n",
        "[spindle]\nclockwise = [\"\"]\n",
    ]);
    let job = format!(
        "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.ngc\"\n{robot}[placement]\n{origin}{}[tool]\n{}{load}{extra}[output]\nprogram = \"own.{}\"\n",
        stands.0,
        tip.0,
        match to {
            "" => "ngc",
            "krl" => "src",
            "rapid" => "mod",
            to => to,
        }
    );
    let cell = format!(
        "schema = 1\nrapid_speed_mm_per_s = 150\n{}[base]\nnumber = 3\n{base}[tool]\nnumber = 2\n{}{spindle}",
        stands.1, tip.1
    );
    (job, cell, to)
}

/// Where `check` finds a fault the program is not written; what is written is verified by the same job, and its original has
/// the error that `deflect` finds.
#[test]
fn one_job_has_one_verdict() {
    let mut random = Random::of_environment();
    random.for_a_while(|random| {
        let (job, cell, to) = job(random);
        let part = *random.one_of(&PARTS);
        let here = tempfile::tempdir().unwrap();
        let here = here.path();
        for (name, text) in [("part.ngc", part), ("job.toml", &job), ("cell.toml", &cell)] {
            std::fs::write(here.join(name), text).unwrap();
        }
        let all = |line: &str| -> Said {
            let words: Vec<&str> = line.split(' ').collect();
            let said = run(here, &words);
            assert!((0..=4).contains(&said.code), "{line}: {job}{cell}{part}: {said:?}");
            said
        };
        let check = all("check job.toml");
        let deflect = all("deflect job.toml --json");
        let compensate = all("compensate job.toml --json");
        let told = format!("{job}\n--- cell\n{cell}\n--- part\n{part}\n--- check {check:?}\n--- deflect {deflect:?}\n--- compensate {compensate:?}");
        let is_written = matches!(compensate.code, 0 | 3 | 4);
        // A place that is not reached, and a fault, are found by all.
        if check.code == 1 {
            assert!(!is_written && compensate.code == 1, "{told}");
        }
        if deflect.code == 1 {
            assert_eq!(check.code, 1, "{told}");
        }
        if check.code == 2 {
            assert!(!is_written, "{told}");
        }
        if !is_written {
            return;
        }
        let of = |said: &Said| -> f64 {
            let value: serde_json::Value = serde_json::from_str(&said.out).unwrap();
            value["summary"]["max_position_error_before_mm"].as_f64().unwrap_or(f64::NAN)
        };
        assert!((of(&compensate) - of(&deflect)).abs() <= 1e-5 * of(&deflect), "{told}");
        let ending = match to {
            "" => "ngc",
            "krl" => "src",
            "rapid" => "mod",
            to => to,
        };
        let verify = all(&format!("verify own.{ending} --job job.toml"));
        assert_eq!(verify.code, compensate.code, "{told}\n--- verify {verify:?}");
    });
}
