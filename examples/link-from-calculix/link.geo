// A straight link of 40 x 60 mm (y, z), 600 mm long, along x from its root at x = 0. Lengths in mm.
Point(1) = {0, -20, -30};
Point(2) = {0,  20, -30};
Point(3) = {0,  20,  30};
Point(4) = {0, -20,  30};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = 5;
Transfinite Surface{1};
Recombine Surface{1};
out[] = Extrude {600, 0, 0} { Surface{1}; Layers{30}; Recombine; };
Physical Surface("ROOT") = {1};
Physical Surface("TIP") = {out[0]};
Physical Volume("LINK") = {out[1]};
Mesh.ElementOrder = 2;
Mesh.SecondOrderIncomplete = 1; // bricks of 20 nodes
Mesh.SaveGroupsOfNodes = 1;
