// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import java.awt.BorderLayout;
import java.awt.GridLayout;
import javax.swing.JPanel;

/** Speed, yaw rate and status of one source. */
final class MotionCurves extends JPanel {
  private final MotionHistory history = new MotionHistory();
  private final MotionChart speed =
      new MotionChart(
          "speed \u00b1 3\u03c3, m/s", 1, "0.0", MotionSample::speedMps, MotionSample::speedStdMps);
  private final MotionChart yawRate =
      new MotionChart(
          "yaw rate \u00b1 3\u03c3, rad/s", 0.05, "0.00", MotionSample::yawRateRadps, MotionSample::yawRateStdRadps);
  private final StatusStrip strip = new StatusStrip(history, yawRate);

  MotionCurves() {
    super(new BorderLayout());
    JPanel charts = new JPanel(new GridLayout(2, 1));
    charts.add(speed);
    charts.add(yawRate);
    speed.setSynchronizedXStartChart(yawRate);
    add(charts, BorderLayout.CENTER);
    add(strip, BorderLayout.SOUTH);
  }

  void add(MotionSample sample) {
    history.add(sample);
  }

  void draw() {
    speed.draw(history);
    yawRate.draw(history);
    strip.repaint();
  }
}
