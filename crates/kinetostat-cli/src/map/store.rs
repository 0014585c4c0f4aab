//! Places that are known already, kept in a directory while the rest is solved: a run that was stopped goes on from there.
//!
//! `manifest.json` says for which question the rows are; `rows.bin` holds rows of 64-bit numbers (least byte first), one for each
//! place in the order of the grid, and behind each block of them a check number. A block that is not whole is solved again with
//! all that follows it. One run at a time writes there.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use kinetostat::chain::FoundBy;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Grid, MapPlace, PlaceState};

use crate::files::hash::{FNV1A, fnv1a};
use crate::files::held_folder::hold;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::system_error::description;

/// Places that are kept together, as a map solves them.
const BLOCK: usize = kinetostat_machining::MAP_BLOCK;
/// Numbers of a place besides its further variables.
const USUAL: usize = 13;
const FOUND: [FoundBy; 6] = [
    FoundBy::Directly,
    FoundBy::OutOfLine,
    FoundBy::GrowingLoad,
    FoundBy::OtherStart,
    FoundBy::Continuation,
    FoundBy::Relaxation,
];

/// Bytes of the check number behind a block.
const CHECK: usize = 8;
/// Interval at which results are saved to the disk.
const EVERY: Duration = Duration::from_secs(5);

/// Word of a manifest with nothing but numbers in it.
pub(crate) const OF_CASES: &str = "orientations_and_loads";

/// Identity of a map, each word of it by its name.
pub(crate) type Manifest = BTreeMap<String, String>;

/// The rows of a directory.
pub(crate) struct Store {
    path: PathBuf,
    rows: File,
    width: usize,
    /// Places that are known.
    pub(crate) known: usize,
    last_on_disk: Instant,
    /// Locked as long as this run lives.
    _lock: File,
}

impl Store {
    /// Opens or begins the rows of a map.
    pub(crate) fn open(
        directory: &Path,
        manifest: &Manifest,
        values: usize,
        places: usize,
    ) -> Answer<Self> {
        let refuse = |path: &Path, what: &dyn std::fmt::Display| {
            ErrorCode::Checkpoint.failure(format!("--resume: '{}': {what}", path.display()))
        };
        fs::create_dir_all(directory).map_err(|e| refuse(directory, &description(&e)))?;
        let lock = hold(directory).map_err(|e| refuse(directory, &description(&e)))?;
        let Some(lock) = lock else {
            let what = "another run keeps its rows there just now: wait until it has ended, or give another directory";
            return Err(refuse(directory, &what));
        };
        let named = directory.join("manifest.json");
        let path = directory.join("rows.bin");
        let wanted = serde_json::to_string_pretty(manifest)
            .map_err(|error| ErrorCode::Checkpoint.failure(error))?;
        let begin = || {
            let mut part =
                tempfile::NamedTempFile::new_in(directory).map_err(|e| refuse(&named, &e))?;
            part.write_all(wanted.as_bytes())
                .and_then(|()| part.as_file().sync_all())
                .map_err(|e| refuse(&named, &e))?;
            part.persist(&named).map_err(|e| refuse(&named, &e))
        };
        match fs::read_to_string(&named) {
            // Cut off by a disk: it may have been this question, which nobody knows of the rows. They are solved again.
            Ok(text) if text.len() < wanted.len() && wanted.starts_with(&text) => {
                match fs::remove_file(&path) {
                    Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
                        return Err(refuse(&path, &description(&e)));
                    }
                    _ => drop(begin()?),
                }
            }
            Ok(text) => {
                let found: Manifest = serde_json::from_str(&text).map_err(|e| {
                    let what = format!(
                        "this is no manifest of a map ({e}); remove the directory and begin again, or give another one"
                    );
                    refuse(&named, &what)
                })?;
                same(&found, manifest).map_err(|what| refuse(&named, &what))?;
            }
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                if path.exists() {
                    return Err(refuse(&path, &"there are rows without a manifest.json"));
                }
                begin()?;
            }
            Err(e) => return Err(refuse(&named, &e)),
        }
        let mut rows = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(|e| refuse(&path, &e))?;
        let width = USUAL + values;
        let known = whole_places(&rows, width, places).map_err(|e| refuse(&path, &e))?;
        let end = bytes_of(known, width);
        rows.set_len(end)
            .and_then(|()| rows.seek(SeekFrom::Start(end)))
            .map_err(|e| refuse(&path, &e))?;
        Ok(Self {
            path,
            rows,
            width,
            known,
            last_on_disk: Instant::now(),
            _lock: lock,
        })
    }

    fn failed(&self, error: &std::io::Error) -> Failure {
        ErrorCode::Checkpoint.failure(format!(
                "--resume: '{}': {}; nothing of what was kept is lost, and the same command goes on from there",
                self.path.display(),
                description(error)
            ),
        )
    }

    /// Known places, block by block.
    pub(crate) fn replay(
        &mut self,
        grid: &Grid,
        mut each: impl FnMut(&[MapPlace]) -> Answer<()>,
    ) -> Answer<()> {
        let file = File::open(&self.path).map_err(|e| self.failed(&e))?;
        let mut reader = BufReader::new(file);
        let mut bytes = vec![0; 8 * self.width];
        for first in (0..self.known).step_by(BLOCK) {
            let end = self.known.min(first + BLOCK);
            let mut places = Vec::with_capacity(end - first);
            for place in first..end {
                reader.read_exact(&mut bytes).map_err(|e| self.failed(&e))?;
                let (numbers, _) = bytes.as_chunks::<8>();
                let row: Vec<f64> = numbers.iter().map(|b| f64::from_le_bytes(*b)).collect();
                places.push(self.place(grid, place, &row)?);
            }
            let mut check = [0; CHECK];
            reader.read_exact(&mut check).map_err(|e| self.failed(&e))?;
            each(&places)?;
        }
        Ok(())
    }

    fn place(&self, grid: &Grid, place: usize, row: &[f64]) -> Answer<MapPlace> {
        let index = grid.index(place);
        let position_mm = [0, 1, 2].map(|axis| grid.position_mm(axis, index[axis]));
        let mut own = MapPlace::unknown(index, position_mm);
        let state = PlaceState::ALL
            .get(row[0] as usize)
            .filter(|_| row[0] >= 0.0);
        let found = FOUND.get(row[1] as usize).filter(|_| row[1] >= 0.0);
        let (Some(state), Some(found)) = (state, found) else {
            return Err(ErrorCode::Checkpoint.failure(format!(
                    "--resume: '{}': row {place} is not one of a map; remove the directory and begin again",
                    self.path.display()
                ),
            ));
        };
        (own.state, own.found_by) = (*state, *found);
        own.tool_turn_deg = row[2];
        own.smallest_stiffness_n_per_mm = row[3];
        own.stiffness_n_per_mm = [row[4], row[5], row[6]];
        own.displacement_mm = [row[7], row[8], row[9]];
        own.rotation_deg = [row[10], row[11], row[12]];
        own.values = row[USUAL..].into();
        Ok(own)
    }

    /// Keeps the next block of places.
    pub(crate) fn keep(&mut self, bytes: &[u8]) -> Answer<()> {
        let written = self.rows.write_all(bytes);
        written.map_err(|e| self.failed(&e))?;
        if self.last_on_disk.elapsed() >= EVERY {
            self.rows.sync_data().map_err(|e| self.failed(&e))?;
            self.last_on_disk = Instant::now();
        }
        Ok(())
    }
}

/// Bytes of so many places, whole blocks but for the last of a map.
fn bytes_of(places: usize, width: usize) -> u64 {
    (8 * width * places + CHECK * places.div_ceil(BLOCK)) as u64
}

/// Places of the blocks that are whole, up to the first that is not.
fn whole_places(rows: &File, width: usize, places: usize) -> std::io::Result<usize> {
    let mut reader = BufReader::new(rows);
    let mut block = Vec::new();
    for first in (0..places).step_by(BLOCK) {
        block.resize(8 * width * BLOCK.min(places - first) + CHECK, 0);
        match reader.read_exact(&mut block) {
            Err(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => return Ok(first),
            read => read?,
        }
        let (numbers, check) = block.split_at(block.len() - CHECK);
        if fnv1a(FNV1A, numbers).to_le_bytes() != check {
            return Ok(first);
        }
    }
    Ok(places)
}

/// Rows of a block of places with its check number.
pub(crate) fn rows(places: &[MapPlace]) -> Vec<u8> {
    let mut out = Vec::new();
    for place in places {
        let found = FOUND.iter().position(|f| *f == place.found_by).unwrap_or(0);
        let head = [
            place.state as u8 as f64,
            found as f64,
            place.tool_turn_deg,
            place.smallest_stiffness_n_per_mm,
        ];
        let rest = [
            place.stiffness_n_per_mm,
            place.displacement_mm,
            place.rotation_deg,
        ];
        let all = head.iter().chain(rest.iter().flatten());
        for number in all.chain(place.values.iter()) {
            out.extend_from_slice(&number.to_le_bytes());
        }
    }
    let check = fnv1a(FNV1A, &out);
    out.extend_from_slice(&check.to_le_bytes());
    out
}

/// The first word in which two manifests differ.
fn same(found: &Manifest, wanted: &Manifest) -> Result<(), String> {
    let names = found.keys().chain(wanted.keys());
    for name in names {
        let of = |m: &Manifest| m.get(name).cloned().unwrap_or_else(|| "nothing".to_owned());
        let (a, b) = (of(found), of(wanted));
        if a != b && name == OF_CASES {
            return Err(
                "the orientations or the loads of the map there are others: give another directory, or remove this one".to_owned(),
            );
        }
        if a != b {
            return Err(format!(
                "{name} is {a} there and {b} here: the rows are those of another map; give another directory, or remove this one"
            ));
        }
    }
    Ok(())
}
