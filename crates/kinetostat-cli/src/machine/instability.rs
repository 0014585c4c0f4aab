//! Nearness of a load to instability, in words: shared by `check` and `deflect`.

use kinetostat_analysis::instability::{InstabilityShares, LimbShare, LinkShare, NOTICEABLE};
use kinetostat_machining::number as formatter;

use crate::ui::numbers::number;
use kinetostat::number::larger;

/// Shares below are nothing.
const NOTHING: f64 = 1e-9;

/// Describes the shares of the way to instability, and the result. `under_load`: on the tool.
pub(crate) fn description(shares: &InstabilityShares<'_>, under_load: bool) -> String {
    let state = shares.state();
    let limb_leads_to = match shares.limb_is_conservative() {
        true => "buckling",
        false => leads_to(false),
    };
    let mut parts = Vec::new();
    match (shares.limb, under_load) {
        (Some(LimbShare { share, limb }), true) if share > NOTHING => parts.push(format!(
            "the load brings limb '{limb}' {} of the way to {}",
            formatter::share(share),
            limb_leads_to
        )),
        (Some(LimbShare { share, limb }), false) if share > NOTHING => parts.push(format!(
            "without load on the tool limb '{limb}' is {} of the way to {}",
            formatter::share(share),
            limb_leads_to
        )),
        (Some(_), true) => parts.push("no load brings a limb towards buckling".to_owned()),
        (Some(_), false) => {
            parts.push("without load on the tool no limb is on the way to buckling".to_owned());
        }
        (None, _) => {}
    }
    let mut most = shares.limb.map_or(0.0, |l| l.share);
    if let Some(LinkShare { share, limb, link }) = shares.link.filter(|l| l.share > 0.0) {
        most = larger(most, share);
        parts.push(format!(
            "the link nearest to its Euler load is '{link}' of '{limb}', {} of it",
            formatter::share(share)
        ));
    }
    // An unstable state has no way to instability left.
    if let Some(share) = shares.free_beyond_limbs().filter(|_| state.stable()) {
        let (nearest, to) = match (share > most, state.conservative) {
            (true, true) => (", which is nearest to instability,", String::new()),
            (false, true) => ("", String::new()),
            (_, false) => ("", format!(" to {}", leads_to(false))),
        };
        parts.push(format!(
            "the machine with its tool free{nearest} goes {} % of the way{to}",
            number(100.0 * share, 3)
        ));
    }
    let mut text = parts.join("; ");
    if text.is_empty() {
        text = "no limb has anything that could buckle".to_owned();
    }
    let reported = most;
    let most = shares.largest();
    text.push_str(match state.stable() {
        false if state.shapes_stable() => ": NOT STABLE, the tool does not stay",
        false => ": NOT STABLE",
        true if shares.is_near_buckling() => ": NEAR BUCKLING",
        true if state.may_flutter() => {
            ": it does not diverge, but may swing with growing amplitude (flutter), which depends on its masses"
        }
        true if most > NOTICEABLE => ": stiffness changes noticeably with the load",
        true if reported > NOTHING => ": far from buckling",
        true => "",
    });
    text
}

/// End of the way that a share measures.
pub(crate) fn leads_to(conservative: bool) -> &'static str {
    match conservative {
        true => "instability",
        false => "where its stiffness is no more positive in every motion",
    }
}
