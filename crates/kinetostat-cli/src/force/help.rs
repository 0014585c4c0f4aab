//! Help of `force` below its options: examples, axes, files, exit codes.

pub(crate) const CODES: &str = "\
Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which";

pub(crate) const FORCE_HELP: &str = "\
Examples:
  kinetostat force --material AlMg4.5Mn --tool flat --diameter-mm 12 --teeth 4 \\
      --helix-deg 38 --width-mm 4 --depth-mm 8 --climb \\
      --feed-per-tooth-mm 0.1 --rpm 8000 --plot cut.svg
      the force of a climb cut over the revolution
  kinetostat force --material C45 --tool face --diameter-mm 63 --teeth 5 \\
      --lead-angle-deg 45 --width-mm 40 --depth-mm 2 --part left \\
      --feed-mm-per-min 800 --rpm 1000 --wear 1.3 --spindle-power-w 7500 \\
      --spindle-base-rpm 1500 --spindle-most-rpm 6000
      a worn face mill: does the spindle bear it?
  kinetostat force --material Ti-6Al-4V --tool-table tools.toml \\
      --tool-number 3 --width-mm 1 --depth-mm 6 --climb \\
      --feed-per-tooth-mm 0.05 --json
  kinetostat force --drill --material C45 --diameter-mm 8 \\
      --feed-per-turn-mm 0.2 --rpm 1200
  kinetostat force --turning --material C45 --depth-mm 2 \\
      --feed-per-turn-mm 0.3 --approach-angle-deg 75 --speed-m-per-min 150
  kinetostat force --list-materials
  kinetostat force --fit means.csv --material \"our 7075\" --tool flat \\
      --diameter-mm 12 --teeth 4 --width-mm 12 --depth-mm 2 \\
      --acts-on part --out-material ours.toml --plot fit.svg
      coefficients of a material from mean forces in a slot

Axes of the force, which is that on the tool: x along the feed of the tool over
the part, y to the left of the feed, z along the tool towards the spindle.
Angles of the spindle count from +y (from -y with --counter-clockwise) to the
place of tooth 0 at the tip, as the spindle turns.

Mean forces for --fit (CSV): a row for each cut, all of them but for the feed
alike; better five feeds than two. Lines that begin with # are passed over.
  feed_mm_per_tooth,fx_n,fy_n,fz_n
  0.05,-95.2,149.7,-19.3
  0.10,-112.3,230.6,-33.6

A table of tools (TOML) has per tool
  [[tool]]
  number = 3            # and name
  shape = \"flat\"        # flat, ball, bull, face
  diameter_mm = 12
  teeth = 4             # and helix_deg, corner_radius_mm, lead_angle_deg,
                        # run_out_um, run_out_angle_deg, rake_deg, max_chip_mm,
                        # flute_length_mm, stick_out_mm, length_mm

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which";
