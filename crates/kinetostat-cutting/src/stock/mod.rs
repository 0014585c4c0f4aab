//! Remaining stock, and contact of a tool with it.
//!
//! Purely geometric. Takes a block, a cylinder, a map of heights or a mesh, and the moves of a tool in the part's frame
//! (z along the tool axis towards the spindle); returns the arcs of the tool in contact at stations along each move.
//!
//! Heights of the material are stored at the points of a grid. Two more numbers at each point give the distances, seen
//! from above, of the next wall down and the next wall up, up to one and a half cells, and two more the normals of
//! these walls: the walls that a tool leaves are placed between the points to the second order of the cell, also where
//! two of them lie in one cell (see [`Stock`]). Source: own work; the distances are those of level sets (Osher and
//! Fedkiw, "Level set methods and dynamic implicit surfaces", 2003, chapter 2: the union of two shapes has the smaller
//! of their distances).

mod arcs;
mod carve;
mod corner;
mod faces;
mod grid;
mod height_map;
mod mesh;
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
