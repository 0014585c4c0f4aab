//! Arcs, or straight pieces, in place of the stretches of a move: as few as follow the corrected curve.
//!
//! Knows: the corrected curve of one move ([`crate::writing::corrected_curve`]) and the tolerances. Takes a stretch without a jump
//! ([`stretch::Span`]), gives its pieces ([`stretch::FittedPiece`]).
//!
//! With a varying correction the corrected curve of an arc is nearly an arc. A stretch of it is taken for one arc about an axis of
//! the same direction, that rises evenly and passes through both ends in its plane ([`circle`]): the centre is where the squares of
//! the radial distances in between are least. Equal ways along the path are not quite equal angles of the new arc; what is left of
//! that after a polynomial of third degree ([`crate::WrittenArc::slip`]) counts as a distance too. The tolerance that remains
//! beside the distances in the plane is a tube about the height of the curve, and an arc that rises evenly is a straight line in it
//! ([`stretch`]).
//!
//! A move is taken whole, or in two or three equal stretches. Otherwise the ends of its pieces may leave the curve along the axis, within
//! the tube ([`free_ends`]): broken lines with free corners need fewer pieces by a factor `sqrt 2` than those with corners on a curve (the
//! largest distance of a parabola of second derivative `k` is `k h^2 / 16` instead of `k h^2 / 8` over pieces of `h`). That such a broken
//! line has as few pieces as it can have, if each is the longest that can be seen in the tube from where the one before was seen, is the
//! theorem of Suri (A linear time algorithm for minimum link paths, 1986) and of Imai and Iri (An optimal algorithm for approximating a
//! piecewise linear function, 1986). If that is not enough, the ends lie on the curve and each piece is as long as it can be ([`search`]).
//! If a piece is shorter than the controller takes, others are looked for ([`long_pieces`]). A straight piece is taken where no arc can be
//! printed: one that is bent by less than its digits, or too small for them.

pub(crate) mod circle;
pub(crate) mod fit;
pub(crate) mod free_ends;
pub(crate) mod long_pieces;
pub(crate) mod stretch;
