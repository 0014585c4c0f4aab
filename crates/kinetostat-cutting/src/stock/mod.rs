//! What is left of the material, and where a tool is in it.
//!
//! Knows geometry alone. Takes a block, a cylinder, a map of heights or a mesh, and the moves of a tool in the part's frame
//! (z along the tool axis towards the spindle); gives the arcs of the tool in contact at stations along each move.
//!
//! The height of the material stands at the points of a grid. Two more numbers at each point say how far away, seen from
//! above, the next wall down and the next wall up are, up to one and a half cells, and two more where these walls look: the
//! walls that a tool leaves are placed between the points to the second order of the cell, also where two of them lie in one
//! cell (see [`Stock`]). Source: own work; the distances are those of level
//! sets (Osher and Fedkiw, "Level set methods and dynamic implicit surfaces", 2003, chapter 2: the union of two shapes has
//! the smaller of their distances).

mod arcs;
mod blank;
mod carve;
mod corner;
mod end;
mod faces;
mod grid;
mod height_map;
mod mesh;
mod normal;
mod probe;
mod profile;
mod rim;
mod settings;
mod sweep;
mod volume;
mod walk;

pub use grid::Stock;
pub use probe::Probe;
pub use settings::StockSettings;
pub use walk::Station;
