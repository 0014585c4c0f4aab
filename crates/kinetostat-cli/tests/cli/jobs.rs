//! What the commands say of jobs that cannot be compensated: the true reason, and what to mend first.

use crate::common::{JOB, run, workplace};

#[test]
fn an_origin_of_the_part_has_a_bound() {
    let here = workplace();
    let job = JOB.replace("[0, 0, 100]", "[1e300, 20, 120]");
    std::fs::write(here.path().join("far.toml"), job).expect("a job");
    std::fs::write(here.path().join("job.toml"), JOB).expect("a job");
    for verb in ["check", "deflect", "compensate"] {
        let said = run(here.path(), &[verb, "far.toml"]);
        assert_eq!(said.code, 1, "{said:?}");
        for wanted in ["far.toml:6", "1e300 mm", "10 km"] {
            assert!(said.err.contains(wanted), "{said:?}");
        }
    }
    let option = ["--part-origin-mm", "0", "0", "-1e12"];
    for verb in ["deflect", "compensate"] {
        let said = run(here.path(), &[&[verb, "job.toml"][..], &option].concat());
        assert_eq!(said.code, 1, "{said:?}");
        assert!(
            said.err.contains("--part-origin-mm: -1000000000000.0 mm"),
            "{said:?}"
        );
    }
}

#[test]
fn check_says_what_is_to_be_mended_before_a_compensation() {
    let here = workplace();
    let next = |job: String| {
        std::fs::write(here.path().join("job.toml"), job).expect("a job");
        let said = run(here.path(), &["check", "job.toml"]);
        let (_, next) = said.out.split_once("\nNext\n").expect("what comes next");
        (said.code, next.to_owned())
    };
    assert_eq!(
        next(JOB.to_owned()),
        (0, "  kinetostat compensate job.toml\n".to_owned())
    );
    let (code, advice) = next(JOB.replace("radial_n = 215", "radial_n = 5200"));
    assert_eq!(code, 1);
    assert!(
        advice.contains("mend first what `kinetostat compensate` refuses"),
        "{advice}"
    );
    let (code, advice) = next(JOB.replace("[0, 0, 100]", "[0, 0, 5000]"));
    assert_eq!(code, 2);
    assert!(advice.contains("does not reach"), "{advice}");
    assert!(
        !advice.contains("kinetostat compensate job.toml"),
        "{advice}"
    );
}

#[test]
fn a_place_out_of_reach_is_not_blamed_on_the_load() {
    let here = workplace();
    let job = JOB
        .replace("radial_n = 215", "radial_n = 5200")
        .replace("[0, 0, 100]", "[0, 0, 5000]");
    std::fs::write(here.path().join("job.toml"), job).expect("a job");
    let said = run(here.path(), &["deflect", "job.toml"]);
    assert_eq!(said.code, 2, "{said:?}");
    assert!(!said.err.contains("force_n"), "{said:?}");
}

/// What `compensate` refuses by a limit, `check` refuses for the same reason; an analysis, which corrects nothing, warns of it.
#[test]
fn a_strict_limit_refuses_where_something_is_corrected() {
    let here = workplace();
    for limits in [
        "correction_mm = 0.001",
        "force_n = 10\ncorrection_mm = 0.001",
    ] {
        let job = format!(
            "{}[limits]\n{limits}\n",
            crate::mirror::job("part.ngc", "orthoglide")
        );
        std::fs::write(here.path().join("job.toml"), job).expect("written");
        let of = |command: &str| run(here.path(), &[command, "job.toml"]);
        let [check, compensate, deflect] = ["check", "compensate", "deflect"].map(of);
        assert_eq!(
            [check.code, compensate.code, deflect.code],
            [1, 1, 0],
            "{check:?} {deflect:?}"
        );
        let limit = limits.split(' ').next().expect("a name");
        for text in [check.err, compensate.err, deflect.out] {
            assert!(text.contains(limit), "{limits}: {text}");
        }
    }
}
