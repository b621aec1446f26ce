"""The figure and the table of what a skin is worth."""

from .plot import panels, save
from .tables import markdown, significant


def title(row):
    return row["scene"] if row["scale"] == 1.0 else f"{row['scene']} ×{row['scale']:g}"


def draw_skins(scenes, path):
    figure, (axis,) = panels(1, 6.0, 3.6)
    for rows in scenes:
        shown = sorted(rows, key=lambda row: row["skin_lengths"])
        axis.plot([row["skin_lengths"] for row in shown], [row["times_no_skin"] for row in shown],
                  marker=".", label=title(shown[0]))
    first = scenes[0][0]
    axis.axhline(1.0, color="black", linewidth=0.5)
    axis.set(xlabel="skin [mean segment lengths]", ylabel="time per frame, that without skin = 1",
             yscale="log",
             title=f"{first['motion']:g} segment lengths per frame, {first['threads']} thread(s)")
    axis.legend()
    save(figure, path)


def coherence_table(scenes):
    lines = []
    for rows in scenes:
        without = next(row for row in rows if row["skin_lengths"] == 0)
        best = min(rows, key=lambda row: row["cycle_ms"])
        lines.append([title(without), without["segments"], significant(without["cycle_ms"]),
                      f"{best['skin_lengths']:g}", significant(best["cycle_ms"]),
                      f"{without['cycle_ms'] / best['cycle_ms']:.1f}×",
                      f"{best['refits']} of {best['frames']}"])
    return markdown(["scene", "segments", "without skin [ms]", "best skin [segment lengths]",
                     "with it [ms]", "faster", "frames that refitted"], lines)
