//! Lobe diagrams: the same for any number of threads, refined where they change, and what is asked is checked.

use kinetostat_chatter::{Instability, LobeRequest};

use crate::support::{aluminium, arc, cut, one_direction, regeneration};

fn machine() -> kinetostat_chatter::Regeneration {
    regeneration(one_direction(), cut(2, arc("down", 0.1), aluminium()))
}

#[test]
fn threads_change_nothing() {
    let request = LobeRequest::new(8000.0, 21000.0, 27, 0.02).refined(1);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| machine().lobes(&request).unwrap())
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one, three);
    assert!(one.points.len() > 27);
    assert!(one.points.windows(2).all(|p| p[0].exact.speed_rpm < p[1].exact.speed_rpm));
    let kinds: Vec<Instability> = one.points.iter().filter_map(|p| Some(p.exact.limit()?.kind)).collect();
    assert!(kinds.contains(&Instability::Flip) && kinds.contains(&Instability::Hopf));
    // A flip is at an odd multiple of half the tooth frequency.
    let mut flips = 0;
    for limit in one.points.iter().filter_map(|p| Some((p.exact.speed_rpm, p.exact.limit()?))) {
        if limit.1.kind == Instability::Flip {
            let halves = limit.1.frequency_hz / (limit.0 * 2.0 / 60.0) * 2.0;
            assert!((halves - halves.round()).abs() < 1e-6 && halves.round() as i64 % 2 == 1, "{halves}");
            flips += 1;
        }
    }
    assert!(flips > 3);
}

#[test]
fn requests_are_checked() {
    let good = LobeRequest::new(8000.0, 9000.0, 3, 0.001);
    for (request, quantity) in [
        (LobeRequest { from_rpm: 0.0, ..good.clone() }, "spindle speed"),
        (LobeRequest { to_rpm: 8000.0, ..good.clone() }, "spindle speeds"),
        (LobeRequest { speeds: 1, ..good.clone() }, "number of spindle speeds"),
        (LobeRequest { up_to: 0.0, ..good.clone() }, "largest depth"),
        (LobeRequest { up_to: -1.0, ..good.clone() }, "depth of cut"),
        (LobeRequest { refinements: 99, ..good.clone() }, "refinement of lobes"),
    ] {
        assert_eq!(machine().lobes(&request).unwrap_err().quantity, quantity);
    }
    // Nothing chatters below the smallest limit: no crossing, no best speed but the first.
    let calm = machine().lobes(&LobeRequest { up_to: 1e-5, ..good }).unwrap();
    assert!(calm.points.iter().all(|p| p.exact.limit().is_none() && p.exact.stable() == [(0.0, 1e-5)]));
}
