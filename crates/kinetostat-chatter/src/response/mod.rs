//! How the tool gives way to a force: modes with damping, and the flexibility of what is left out.
//!
//! Takes modal data at the cutting point; gives receptances in any frame. Sources: `dynamics.md` sections 3, 7 and 8.

mod coupling;
mod first_order;
mod frame;
mod mode;
mod tool;

pub use frame::FeedFrame;
pub use mode::Mode;
pub use tool::ToolResponse;

pub(crate) use coupling::Coupling;
pub(crate) use first_order::first_order;
