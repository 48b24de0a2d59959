//! The page of mismatches between the true array and the assumed one.

use std::fmt::Write as _;

use super::table::Show::{Code, Fixed, Percent};
use super::table::{Column, NoKey, pivot, text, value};
use super::tables::{names, those};
use crate::json::Json;

/// The page, from the summary of a sweep.
pub(super) fn page(outputs: &[Json]) -> Result<String, NoKey> {
    let groups = value(&outputs[0], "groups")?.items();
    let scene = |group: &Json| text(group, "scenes").map(str::to_owned);
    let mismatch = Column("mismatch", "settings.mismatch", Code);
    let mut page = String::from(
        "\nA row has the [mismatch](../mismatch.md#keys) of the runs. `{}` is none. A dash means that the run was not complete. Shares are of the tips of all \
         runs, also of incomplete ones.\n",
    );
    for policy in names(groups, "policy")? {
        let runs = those(groups, |group| Ok(text(group, "policy")? == policy))?;
        let table = |figure| pivot(runs.iter().copied(), mismatch, scene, figure);
        let _ = write!(
            page,
            "\n## `{policy}.fsm`\n\nMean errors, mm:\n\n{}\nTips within their 95 % interval, %:\n\n{}",
            table(("error_mean_mm", Fixed(2)))?,
            table(("within_band", Percent(0)))?
        );
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_row_for_each_mismatch_and_a_column_for_each_scene() -> Result<(), NoKey> {
        let group = |mismatch: &str, scenes: &str, error: &str| {
            format!(
                r#"{{"scenes": "{scenes}", "settings": {{"mismatch": "{mismatch}"}}, "policy": "thesis", "error_mean_mm": {error},
                "within_band": 0.5}}"#
            )
        };
        let groups = [
            ("{}", "disk", "0.03"),
            ("{}", "box", "0.01"),
            ("{servo: 1 s}", "disk", "2"),
            ("{servo: 1 s}", "box", "null"),
        ];
        let groups = groups.map(|(mismatch, scenes, error)| group(mismatch, scenes, error)).join(",");
        let output = Json::read(&format!(r#"{{"groups": [{groups}]}}"#)).unwrap_or(Json::Null);
        let page = page(&[output])?;
        assert!(page.contains("| mismatch | disk | box |\n|---|---|---|\n| `{}` | 0.03 | 0.01 |\n"), "{page}");
        assert!(page.contains("| `{servo: 1 s}` | 2.00 | – |\n"), "{page}");
        Ok(())
    }
}
