// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import info.monitorenter.gui.chart.Chart2D;
import info.monitorenter.gui.chart.IAxis;
import info.monitorenter.gui.chart.IAxis.AxisTitle;
import info.monitorenter.gui.chart.ITrace2D;
import info.monitorenter.gui.chart.axis.AxisLinear;
import info.monitorenter.gui.chart.axis.scalepolicy.AxisScalePolicyManualTicks;
import info.monitorenter.gui.chart.labelformatters.LabelFormatterNumber;
import info.monitorenter.gui.chart.rangepolicies.RangePolicyFixedViewport;
import info.monitorenter.gui.chart.rangepolicies.RangePolicyMinimumViewport;
import info.monitorenter.gui.chart.traces.Trace2DSimple;
import info.monitorenter.util.Range;
import java.awt.BasicStroke;
import java.awt.Color;
import java.text.DecimalFormat;
import java.text.DecimalFormatSymbols;
import java.util.List;
import java.util.Locale;
import java.util.function.ToDoubleFunction;

/** A curve over time in its band of 3 sigma. */
final class MotionChart extends Chart2D {
  static final Color LINE = new Color(0x0D47A1);
  static final Color BAND = new Color(0xBBDEFB);

  private final ToDoubleFunction<MotionSample> value;
  private final ToDoubleFunction<MotionSample> sigma;
  private final ITrace2D band = new Trace2DSimple("3 sigma");
  private final ITrace2D line;
  private final AxisLinear<AxisScalePolicyManualTicks> y =
      new AxisLinear<>(new LabelFormatterNumber(), new AxisScalePolicyManualTicks());

  /** `least`: the axis reaches from -least to least at least. */
  MotionChart(
      String name,
      double least,
      String format,
      ToDoubleFunction<MotionSample> value,
      ToDoubleFunction<MotionSample> sigma) {
    this.value = value;
    this.sigma = sigma;
    line = new Trace2DSimple(name);
    setBackground(Color.WHITE);
    setGridColor(new Color(0xE0E0E0));
    setPaintLabels(false); // The axis names it.
    setAxisYLeft(y, 0);
    getAxisX().setRangePolicy(new RangePolicyFixedViewport(new Range(0, MotionHistory.SPAN_S)));
    y.setRangePolicy(new RangePolicyMinimumViewport(new Range(-least, least)));
    label(getAxisX(), "s", "0");
    label(y, name, format);
    addTrace(band, BAND);
    addTrace(line, LINE);
    band.setTracePainter(new BandPainter());
    line.setStroke(new BasicStroke(1.5f, BasicStroke.CAP_ROUND, BasicStroke.JOIN_ROUND));
  }

  void draw(MotionHistory history) {
    double end = Math.max(history.lastSeconds(), MotionHistory.SPAN_S);
    getAxisX().getRangePolicy().setRange(new Range(end - MotionHistory.SPAN_S, end));
    getAxisX().getAxisTitle().setTitle("s after utime " + history.startUtime());
    band.removeAllPoints();
    line.removeAllPoints();
    for (List<MotionSample> piece : history.pieces()) {
      if (line.getSize() > 0) { // NaN ends the piece before.
        line.addPoint(history.seconds(piece.get(0)), Double.NaN);
        band.addPoint(history.seconds(piece.get(0)), Double.NaN);
      }
      piece.forEach(sample -> addPoint(history.seconds(sample), sample));
    }
    Range range = y.getRangePolicy().getRange();
    double step =
        roundStep(
            Math.max(range.getMax(), band.getMaxY()) - Math.min(range.getMin(), band.getMinY()));
    y.setMajorTickSpacing(step);
    y.setMinorTickSpacing(step);
  }

  /** 1, 2 or 5 times a power of ten, two to five times in the range. */
  private static double roundStep(double range) {
    double power = Math.pow(10, Math.floor(Math.log10(range / 2)));
    double factor = range / 2 / power;
    return power * (factor < 2 ? 1 : factor < 5 ? 2 : 5);
  }

  private void addPoint(double seconds, MotionSample sample) {
    double at = value.applyAsDouble(sample);
    double width = 3 * sigma.applyAsDouble(sample);
    line.addPoint(seconds, at);
    band.addPoint(seconds, at - width);
    band.addPoint(seconds, at + width);
  }

  private void addTrace(ITrace2D trace, Color color) {
    trace.setColor(color);
    addTrace(trace);
  }

  private static void label(IAxis<?> axis, String title, String format) {
    axis.setAxisTitle(new AxisTitle(title));
    axis.setPaintGrid(true);
    axis.setFormatter(
        new LabelFormatterNumber(
            new DecimalFormat(format, DecimalFormatSymbols.getInstance(Locale.ROOT))));
  }
}
