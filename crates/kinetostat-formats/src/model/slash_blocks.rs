//! Blocks that a switch at the machine leaves out.

/// Reason and remedy of a refused block with a slash.
pub(crate) const SLASHED: (&str, &str) = (
    "whether the block runs, depends on a switch at the machine (/)",
    "say it (--block-delete run or skip), or take the slash out, or the block",
);

/// Treatment of blocks with a slash (SINUMERIK: `/N50`, `/0` to `/9`; Heidenhain: `/12 L X+5`), which a switch at the machine skips.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SlashBlocks {
    /// They are refused with their lines, but for those that change neither places nor what follows.
    #[default]
    Refused,
    /// They run, with a finding.
    Run,
    /// They are carried as they are written, and do nothing, with a finding.
    Skipped,
}
