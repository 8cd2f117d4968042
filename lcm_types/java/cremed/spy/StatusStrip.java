// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import info.monitorenter.gui.chart.Chart2D;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.event.MouseEvent;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import javax.swing.JComponent;
import javax.swing.ToolTipManager;

/** Statuses over time, below a chart and with its axis: coloured, with their names. */
final class StatusStrip extends JComponent {
  static final Color OK = new Color(0x66BB6A);
  private static final Color NO_ESTIMATE = new Color(0xE57373);
  private static final Color BEGIN = new Color(0xFFD54F);
  private static final Map<String, Color> COLORS =
      Map.of(
          "ok", OK,
          "standing_still", new Color(0x4DB6AC),
          "predicted", new Color(0xFFB74D),
          "initialising", BEGIN,
          "no_reference", BEGIN);
  private static final int HEIGHT_PX = 24;

  private final MotionHistory history;
  private final Chart2D chart;

  /** One status without a break. */
  private record Run(String status, int left, int right) {}

  StatusStrip(MotionHistory history, Chart2D chart) {
    this.history = history;
    this.chart = chart;
    setPreferredSize(new Dimension(0, HEIGHT_PX));
    ToolTipManager.sharedInstance().registerComponent(this);
  }

  @Override
  protected void paintComponent(Graphics graphics) {
    for (Run run : runs()) {
      int width = run.right - run.left;
      graphics.setColor(COLORS.getOrDefault(run.status, NO_ESTIMATE));
      graphics.fillRect(run.left, 2, Math.max(width, 2), HEIGHT_PX - 4);
      graphics.setColor(Color.BLACK);
      if (graphics.getFontMetrics().stringWidth(run.status) + 6 < width) {
        graphics.drawString(run.status, run.left + 3, HEIGHT_PX - 8);
      }
    }
  }

  @Override
  public String getToolTipText(MouseEvent event) {
    for (Run run : runs()) {
      if (event.getX() >= run.left && event.getX() <= run.right) {
        return run.status;
      }
    }
    return null;
  }

  private List<Run> runs() {
    List<Run> runs = new ArrayList<>();
    MotionSample before = null;
    for (MotionSample sample : history.samples()) {
      int right = pixel(sample);
      boolean isNext = before != null && sample.isNextTo(before);
      if (isNext && sample.status().equals(before.status())) {
        Run last = runs.remove(runs.size() - 1);
        runs.add(new Run(last.status, last.left, right));
      } else {
        runs.add(new Run(sample.status(), isNext ? pixel(before) : right, right));
      }
      before = sample;
    }
    return runs;
  }

  private int pixel(MotionSample sample) {
    return chart.getAxisX().translateValueToPx(history.seconds(sample));
  }
}
