//! Frequencies of the request, and checks of the combination of options.

use crate::frf::arguments::FrfArgs;
use crate::ui::failure::{Answer, Failure};

/// Upper limit of the frequencies of a response.
const MOST: f64 = 200_000.0;

/// Refuses options that say nothing together.
pub(crate) fn makes_sense(
    args: &FrfArgs,
    frequencies: &[f64],
    entries: &[(usize, usize)],
) -> Answer<()> {
    let is_drawn = args.outputs.plot.is_some();
    if let ([one], true) = (frequencies, is_drawn || args.fit.is_some()) {
        return Err(Failure::input(format!(
            "--frequencies names one frequency, {one} Hz; --plot and --fit need a band"
        )));
    }
    if is_drawn && !entries.iter().any(|(to, from)| *to < 3 && *from < 3) {
        return Err(Failure::input(
            "--plot draws motions along axes by forces along axes; there is none among --to and --from",
        ));
    }
    Ok(())
}

/// Evenly spaced frequencies, Hz.
pub(crate) fn frequencies(of: &[f64]) -> Answer<Vec<f64>> {
    let &[low, high, count] = of else {
        return Err(Failure::input("--frequencies needs LO HI N"));
    };
    if count == 1.0 && low == high && low >= 0.0 && low.is_finite() {
        return Ok(vec![low]);
    }
    if !(low >= 0.0 && high > low && high.is_finite()) {
        return Err(Failure::input(format!(
            "--frequencies {low} {high}: frequencies in Hz are needed, the first not below 0 and the second above the first"
        )));
    }
    if !(2.0..=MOST).contains(&count) || count.fract() != 0.0 {
        return Err(Failure::input(format!(
            "--frequencies: N is {count}; a whole number from 2 to {MOST} is needed, or 1 with the same frequency twice"
        )));
    }
    let count = count as usize;
    let step = (high - low) / (count - 1) as f64;
    Ok((0..count).map(|i| low + step * i as f64).collect())
}
