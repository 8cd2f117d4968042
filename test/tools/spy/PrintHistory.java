// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What cremed-spy draws of an LCM log, a line a sample, and its history of made samples:
// PrintHistory LOG
import cremed.ego_motion_t;
import cremed.odometry_t;
import cremed.spy.MotionHistory;
import cremed.spy.MotionSample;
import java.io.EOFException;
import java.util.stream.Collectors;
import lcm.logging.Log;

public final class PrintHistory {
  private static final long STEP_US = 100_000;

  public static void main(String[] arguments) throws Exception {
    printGaps();
    printBounds();
    Log log = new Log(arguments[0], "r");
    try {
      while (true) {
        print(log.readNext());
      }
    } catch (EOFException end) {
      return;
    }
  }

  private static void print(Log.Event event) throws Exception {
    if (event.channel.equals("CREMED_ODOMETRY")) {
      print(event.channel, MotionSample.of(new odometry_t(event.data)));
    } else if (event.channel.equals("CREMED_EGO_MOTION")) {
      print(event.channel, MotionSample.of(new ego_motion_t(event.data)));
    }
  }

  private static void print(String channel, MotionSample sample) {
    System.out.printf(
        "%s %d %s %s %s %s %s %s%n",
        channel, sample.utime(), sample.source(), sample.status(), sample.speedMps(),
        sample.speedStdMps(), sample.yawRateRadps(), sample.yawRateStdRadps());
  }

  private static MotionSample made(long seq, long utime, String status, double speedMps) {
    return new MotionSample(utime, seq, "made", status, speedMps, 0.1, 0, 0.01);
  }

  /** No estimate at 2, 5 lost, 0.6 s without a message before 8. */
  private static void printGaps() {
    MotionHistory history = new MotionHistory();
    for (long seq = 0; seq < 10; ++seq) {
      boolean isUsable = seq != 2;
      long utime = STEP_US * seq + (seq < 8 ? 0 : 5 * STEP_US);
      if (seq != 5) {
        history.add(
            made(seq, utime, isUsable ? "ok" : "lost", isUsable ? seq : Double.NaN));
      }
    }
    System.out.println(
        history.pieces().stream()
            .map(
                piece ->
                    piece.stream()
                        .map(sample -> "" + sample.seq())
                        .collect(Collectors.joining(" ")))
            .collect(Collectors.joining(", ")));
  }

  /** 100 s at 10 Hz, then at 1000 Hz, then a clock set back. */
  private static void printBounds() {
    MotionHistory history = new MotionHistory();
    for (long seq = 0; seq <= 1000; ++seq) {
      history.add(made(seq, STEP_US * seq, "ok", 1));
    }
    System.out.print(history.samples().size() + " " + history.lastSeconds());
    for (long seq = 0; seq <= 20_000; ++seq) {
      history.add(made(seq, 1000 * STEP_US + 1000 * seq, "ok", 1));
    }
    System.out.print(" " + history.samples().size());
    history.add(made(0, 5, "ok", 1));
    System.out.println(" " + history.samples().size() + " " + history.startUtime());
  }
}
