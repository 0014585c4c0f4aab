//! Places along a path as it is drawn: its feed moves by their length, the feet of points on it, and points in their order.

pub(crate) mod foot;
pub(crate) mod in_order;
pub(crate) mod nominal;
