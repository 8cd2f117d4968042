// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.Collection;
import java.util.Collections;
import java.util.Deque;
import java.util.List;

/** The last 30 s of one source, by the stamps of its messages. */
public final class MotionHistory {
  public static final double SPAN_S = 30;
  public static final int CAPACITY = 6000; // 200 a second.

  private final Deque<MotionSample> samples = new ArrayDeque<>(CAPACITY);
  private long startUtime;

  /** A stamp before the last one begins anew: another replay, or a clock that was set. */
  public void add(MotionSample sample) {
    if (!samples.isEmpty() && sample.utime() < samples.getLast().utime()) {
      samples.clear();
    }
    if (samples.isEmpty()) {
      startUtime = sample.utime();
    }
    samples.addLast(sample);
    while (samples.size() > CAPACITY || ageS(samples.getFirst()) > SPAN_S) {
      samples.removeFirst();
    }
  }

  public Collection<MotionSample> samples() {
    return Collections.unmodifiableCollection(samples);
  }

  /** The stamp that seconds() counts from. */
  public long startUtime() {
    return startUtime;
  }

  public double seconds(MotionSample sample) {
    return 1e-6 * (sample.utime() - startUtime);
  }

  public double lastSeconds() {
    return samples.isEmpty() ? 0 : seconds(samples.getLast());
  }

  /** Usable samples in a row, none missing: each list is one piece of a curve. */
  public List<List<MotionSample>> pieces() {
    List<List<MotionSample>> pieces = new ArrayList<>();
    MotionSample before = null;
    for (MotionSample sample : samples) {
      if (sample.isUsable()) {
        if (before == null || !before.isUsable() || !sample.isNextTo(before)) {
          pieces.add(new ArrayList<>());
        }
        pieces.get(pieces.size() - 1).add(sample);
      }
      before = sample;
    }
    return pieces;
  }

  private double ageS(MotionSample sample) {
    return 1e-6 * (samples.getLast().utime() - sample.utime());
  }
}
