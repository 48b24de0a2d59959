//! The table of README.md, from the pages of the bench and of the mismatches.

use super::mismatch::BENCHES;

/// The headings of the columns with figures. The first two columns, scene and baseline, are written by hand.
const HEADINGS: [&str; 5] = [
    "`thesis.fsm`, ideal array",
    "`thesis.fsm`, plausible array",
    "`vibrissa.fsm`, ideal array",
    "`vibrissa.fsm`, plausible array",
    "coverage, `vibrissa.fsm`",
];
/// The figure of a page that has none.
const NONE: &str = "–";

/// README.md with the figures of the pages in its table. `None` if it has no table of scenes.
pub(super) fn with_figures(readme: &str, bench: &str, mismatch: &str) -> Option<String> {
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
                cells.extend(figures(&scene, bench, mismatch));
            }
        }
        format!("| {} |", cells.join(" | "))
    });
    let (before, after) = (&lines[..first], &lines[first + rows.len()..]);
    let all = before.iter().map(|line| (*line).to_owned()).chain(table);
    let all: Vec<_> = all.chain(after.iter().map(|line| (*line).to_owned())).collect();
    Some(all.join("\n") + "\n")
}

/// The figures of a scene in the order of [`HEADINGS`].
fn figures(scene: &str, bench: &str, mismatch: &str) -> [String; 5] {
    let of_bench = |policy: &str, heading| find(bench, "", &[scene, &format!("`{policy}`")], heading);
    let of_array = |policy: &str| find(mismatch, &format!("## Arrays under `{policy}.fsm`"), &[scene], BENCHES[1]);
    let coverage = of_bench("vibrissa", "coverage, %").map(|coverage| format!("{coverage} %"));
    let figures = [
        of_bench("thesis", "mean error, mm"),
        of_array("thesis"),
        of_bench("vibrissa", "mean error, mm"),
        of_array("vibrissa"),
        coverage,
    ];
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
        let table = |mismatch| {
            let readme = with_figures(README, bench, mismatch).unwrap_or_default();
            assert!(
                readme.starts_with("# A\n\n| scene | baseline | `thesis.fsm`, ideal") && readme.ends_with("|\n\nB\n")
            );
            readme.lines().nth(4).map(str::to_owned).unwrap_or_default()
        };
        assert_eq!(table(""), "| round tunnel | about 3 | 0.4 | – | 0.2 | – | 96 % |");
        let array = |policy: &str, error: &str| {
            format!(
                "## Arrays under `{policy}.fsm`\n\n| scene | ideal | {} |\n|---|---|---|\n| round-tunnel | 1 | {error} |\n",
                BENCHES[1]
            )
        };
        let mismatch = array("thesis", "0.8") + &array("vibrissa", "timeout");
        assert_eq!(table(&mismatch), "| round tunnel | about 3 | 0.4 | 0.8 | 0.2 | timeout | 96 % |");
        assert_eq!(with_figures("no table", bench, ""), None);
    }

    #[test]
    fn the_table_of_the_readme_has_the_figures_of_the_pages() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
        let text = |name: &str| fs::read_to_string(root.join(name)).unwrap_or_default();
        let (readme, bench) = (text("README.md"), text("docs/results/bench.md"));
        let expected = with_figures(&readme, &bench, &text("docs/results/mismatch.md"));
        assert_eq!(expected, Some(readme.clone()), "run cargo x results bench mismatch");
        let rows: Vec<_> = readme.lines().skip_while(|line| !line.starts_with("| scene |")).skip(2).collect();
        let rows: Vec<_> = rows.into_iter().take_while(|line| line.starts_with('|')).map(cells).collect();
        assert_eq!(rows.len(), 10);
        // The page of the bench has all figures of every scene, so only those of the mismatches may be missing.
        for row in rows {
            assert!([2, 4, 6].iter().all(|&column| row[column] != NONE), "{row:?}");
        }
    }
}
