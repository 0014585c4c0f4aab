//! `kinetostat reproduce`: the numbers of the report beside their print.

use crate::args::ReproduceArgs;
use crate::failure::{Answer, Failure};

pub(crate) fn run(args: &ReproduceArgs) -> Answer<()> {
    let _ = (&args.id, args.json, &args.html, args.force_overwrite);
    Err(Failure::unanswered("nothing is reproduced yet"))
}
