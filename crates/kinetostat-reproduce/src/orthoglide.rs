//! The Orthoglide of chapters 5.5.3, 6 and 7.

mod assembly;
mod bars;
mod flat;
mod machine;
mod toggle;

pub(crate) use assembly::{table_6_1, table_6_2};
pub(crate) use flat::{fig_5_11, table_5_3};

use crate::{Cause, Contents, Item, Status};

fn not_written_yet() -> Contents {
    Contents {
        items: vec![Item {
            name: "all".into(),
            printed: None,
            computed: None,
            unit: String::new(),
            status: Status::NoPrint,
            note: "not written yet".into(),
        }],
        plots: Vec::new(),
    }
}

pub(crate) fn fig_6_6() -> Result<Contents, Cause> {
    Ok(not_written_yet())
}

pub(crate) fn fig_6_7() -> Result<Contents, Cause> {
    Ok(not_written_yet())
}

pub(crate) fn fig_7_5() -> Result<Contents, Cause> {
    Ok(not_written_yet())
}

pub(crate) fn fig_7_6() -> Result<Contents, Cause> {
    Ok(not_written_yet())
}

pub(crate) fn fig_7_7() -> Result<Contents, Cause> {
    Ok(not_written_yet())
}

pub(crate) fn fig_7_8() -> Result<Contents, Cause> {
    Ok(not_written_yet())
}
