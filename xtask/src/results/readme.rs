//! The table of README.md, from the pages of the bench and of real arrays.

use super::stamp::Stamp;

/// The beginning of the line above the table: what it was made from.
const MADE_FROM: &str = "<!-- the table below is made from";

/// The headings of the columns with figures. The first two columns, scene and baseline, are written by hand.
const HEADINGS: [&str; 5] = [
    "`thesis.fsm`, real arrays",
    "`vibrissa.fsm`, real arrays",
    "coverage, `vibrissa.fsm`, real arrays",
    "`thesis.fsm`, ideal array",
    "`vibrissa.fsm`, ideal array",
];
/// The figure of a page that has none.
const NONE: &str = "–";

/// README.md with the figures of the pages in its table. `None` if it has no table of scenes.
pub(super) fn with_figures(readme: &str, bench: &str, real: &str) -> Option<String> {
    let lines: Vec<_> = readme.lines().collect();
    let first = lines.iter().position(|line| line.starts_with("| scene |"))?;
    let rows: Vec<_> = lines[first..].iter().take_while(|line| line.starts_with('|')).copied().collect();
    let table = rows.iter().enumerate().map(|(index, row)| {
        let mut cells: Vec<_> = cells(row).into_iter().take(2).collect();
        match index {
            0 => cells.extend(HEADINGS.map(str::to_owned)),
            1 => return format!("|{}", "---|".repeat(2 + HEADINGS.len())),
            _ => {
                let scene = cells.first().map(|name| name.replace(' ', "-")).unwrap_or_default();
                cells.extend(figures(&scene, bench, real));
            }
        }
        format!("| {} |", cells.join(" | "))
    });
    let before = lines[..first].iter().filter(|line| !line.starts_with(MADE_FROM));
    let after = &lines[first + rows.len()..];
    let hash = |page| Stamp::read(page).map_or_else(|| "without a stamp".to_owned(), |stamp| stamp.hash());
    let (bench, real) = (hash(bench), hash(real));
    let stamp = format!("{MADE_FROM} docs/results/bench.md, {bench}, and docs/results/real.md, {real} -->");
    let all = before.map(|line| (*line).to_owned()).chain([stamp]).chain(table);
    let all: Vec<_> = all.chain(after.iter().map(|line| (*line).to_owned())).collect();
    Some(all.join("\n") + "\n")
}

/// The figures of a scene in the order of [`HEADINGS`]. An ideal run that is not complete has its outcome instead of its error. The
/// error of real arrays has the number of incomplete runs, if there are any.
fn figures(scene: &str, bench: &str, real: &str) -> [String; 5] {
    let of_bench = |policy: &str, heading| find(bench, "", &[scene, &format!("`{policy}`")], heading);
    let of_arrays = |policy: &str, heading| find(real, &format!("## `{policy}.fsm`"), &[scene], heading);
    let real_error = |policy: &str| {
        let error = of_arrays(policy, "mean error, mm")?;
        let incomplete =
            ["ended", "others"].iter().filter_map(|heading| of_arrays(policy, heading)?.parse::<u32>().ok());
        Some(match incomplete.sum::<u32>() {
            0 => error,
            incomplete => format!("{error}, {incomplete} incomplete"),
        })
    };
    let error = |policy: &str| match of_bench(policy, "outcome") {
        Some(outcome) if outcome != "completed" => Some(outcome),
        _ => of_bench(policy, "mean error, mm"),
    };
    let coverage = of_arrays("vibrissa", "coverage, %").map(|coverage| format!("{coverage} %"));
    let figures = [real_error("thesis"), real_error("vibrissa"), coverage, error("thesis"), error("vibrissa")];
    figures.map(|figure| figure.unwrap_or_else(|| NONE.to_owned()))
}

/// The cell in the column with this `heading`, of the first row below the line `title` that begins with the cells `row`.
fn find(page: &str, title: &str, row: &[&str], heading: &str) -> Option<String> {
    let mut column = None;
    for line in page.lines().skip_while(|line| !line.starts_with(title)) {
        let cells = cells(line);
        if let Some(found) = cells.iter().position(|cell| cell == heading) {
            column = Some(found);
        } else if !line.starts_with('|') {
            column = None;
        } else if cells.len() > row.len()
            && cells.iter().zip(row).all(|(cell, name)| cell == name)
            && let Some(column) = column
        {
            return cells.get(column).cloned();
        }
    }
    None
}

/// The cells of a row of a table.
fn cells(row: &str) -> Vec<String> {
    row.trim().trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::Path;

    const README: &str = "# A\n\n| scene | baseline | old |\n|---|---|---|\n| round tunnel | about 3 | 9 |\n\nB\n";

    #[test]
    fn figures_come_from_the_table_with_their_heading_and_a_missing_page_leaves_dashes() {
        let bench = "| scene | policy | radius |\n|---|---|---|\n| round-tunnel | `thesis` | 7 |\n\n\
                     | scene | policy | mean error, mm | coverage, % |\n|---|---|---|---|\n\
                     | round-tunnel | `thesis` | 0.4 | 95 |\n| round-tunnel | `vibrissa` | 0.2 | 96 |\n";
        let table = |real| {
            let readme = with_figures(README, bench, real).unwrap_or_default();
            assert!(
                readme.starts_with("# A\n\n<!-- the table")
                    && readme.ends_with("|\n\nB\n")
                    && readme.contains("-->\n| scene |")
            );
            readme.lines().nth(5).map(str::to_owned).unwrap_or_default()
        };
        assert_eq!(table(""), "| round tunnel | about 3 | – | – | – | 0.4 | 0.2 |");
        let arrays = |policy: &str, error: &str, ended: u32| {
            format!(
                "## `{policy}.fsm`\n\n| scene | mean error, mm | coverage, % | ended | others |\n|---|---|---|---|---|\n\
                 | round-tunnel | {error} | 97 | {ended} | 1 |\n"
            )
        };
        let real = arrays("thesis", "0.8", 2) + &arrays("vibrissa", "0.3", 0).replace("| 1 |", "| 0 |");
        assert_eq!(table(&real), "| round tunnel | about 3 | 0.8, 3 incomplete | 0.3 | 97 % | 0.4 | 0.2 |");
        assert_eq!(with_figures("no table", bench, ""), None);
        // A second time, there is still one stamp.
        let once = with_figures(README, bench, &real).unwrap_or_default();
        assert_eq!(with_figures(&once, bench, &real), Some(once));
    }

    #[test]
    fn a_run_that_is_not_complete_has_its_outcome_and_the_table_has_the_stamps_of_its_pages() {
        let bench = "| scene | policy | outcome | mean error, mm | coverage, % |\n|---|---|---|---|---|\n\
                     | round-tunnel | `thesis` | ended | 0.4 | 50 |\n| round-tunnel | `vibrissa` | completed | 0.2 | 96 |\n";
        let stamped = |hash: &str| format!("{bench}\n<!-- made from\na.fsm {hash}\n-->\n");
        let readme = |hash| with_figures(README, &stamped(hash), "").unwrap_or_default();
        assert!(readme("1").contains("| round tunnel | about 3 | – | – | – | ended | 0.2 |\n"), "{}", readme("1"));
        assert_ne!(readme("1"), readme("2"));
    }

    /// That the figures are those of the pages is the check of published figures, `cargo x results --check`.
    #[test]
    fn the_table_of_the_readme_has_a_figure_or_an_outcome_for_every_scene() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
        let readme = fs::read_to_string(root.join("README.md")).unwrap_or_default();
        let rows: Vec<_> = readme.lines().skip_while(|line| !line.starts_with("| scene |")).skip(2).collect();
        let rows: Vec<_> = rows.into_iter().take_while(|line| line.starts_with('|')).map(cells).collect();
        assert_eq!(rows.len(), 10);
        for row in rows {
            assert!(row.len() == 2 + HEADINGS.len() && row.iter().all(|cell| cell != NONE), "{row:?}");
        }
    }
}
