//! The picture: the map of the stock, where there is one, above the charts along the path.

use kinetostat_cutting::Stock;
use kinetostat_machining::EngagementSource;
use kinetostat_program::Path;
use kinetostat_report::engagement_svg;

use crate::engagement::answer::EngagementAnswer;
use crate::engagement::map::map;

pub(crate) fn drawing(
    a: &EngagementAnswer,
    source: &EngagementSource,
    left: Option<&Stock>,
    path: &Path,
) -> String {
    let map = match (source, left) {
        (EngagementSource::Stock(whole), Some(left)) => Some(map(a, whole, left, path)),
        _ => None,
    };
    let title = format!(
        "{} in {}: what is cut along the path",
        a.program, a.material
    );
    engagement_svg(&a.cutting, map.as_ref(), &title)
}
