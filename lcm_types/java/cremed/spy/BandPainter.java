// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import info.monitorenter.gui.chart.ITracePoint2D;
import info.monitorenter.gui.chart.traces.painters.ATracePainter;
import java.awt.Graphics;

/** Fills the strip between points that alternate from its lower to its upper edge. */
final class BandPainter extends ATracePainter {
  private boolean hasBefore;
  private int beforeX;
  private int beforeY;

  @Override
  public void startPaintIteration(Graphics graphics) {
    super.startPaintIteration(graphics);
    hasBefore = false;
  }

  /** Of three points in a row a triangle; the first two are a line, which shows a single sample. */
  @Override
  public void paintPoint(int x, int y, int nextX, int nextY, Graphics graphics, ITracePoint2D next) {
    super.paintPoint(x, y, nextX, nextY, graphics, next);
    graphics.drawLine(x, y, nextX, nextY);
    if (hasBefore) {
      graphics.fillPolygon(new int[] {beforeX, x, nextX}, new int[] {beforeY, y, nextY}, 3);
    }
    hasBefore = true;
    beforeX = x;
    beforeY = y;
  }

  @Override
  public void discontinue(Graphics graphics) {
    super.discontinue(graphics);
    hasBefore = false;
  }
}
