// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import cremed.ego_motion_t;
import cremed.odometry_t;
import java.io.DataInput;
import java.io.IOException;
import java.io.UncheckedIOException;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.ArrayBlockingQueue;
import java.util.concurrent.BlockingQueue;
import java.util.regex.Pattern;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/** Hears every motion on a channel; lcm-spy itself keeps only the last message. */
final class MotionListener implements LCMSubscriber {
  private final long fingerprint;
  private final LCM lcm;
  private final BlockingQueue<MotionSample> heard =
      new ArrayBlockingQueue<>(MotionHistory.CAPACITY); // Later ones are lost while it is full.

  static boolean isMotion(long fingerprint) {
    return fingerprint == odometry_t.LCM_FINGERPRINT || fingerprint == ego_motion_t.LCM_FINGERPRINT;
  }

  /** Listens at $LCM_DEFAULT_URL, which cremed-spy sets from its option. */
  MotionListener(String channel, long fingerprint) {
    this.fingerprint = fingerprint;
    try {
      lcm = new LCM();
    } catch (IOException e) {
      throw new UncheckedIOException(e);
    }
    lcm.subscribe(Pattern.quote(channel), this);
  }

  @Override
  public void messageReceived(LCM from, String channel, LCMDataInputStream data) {
    try {
      heard.offer(sample(data));
    } catch (IOException e) {
      System.err.println("cremed-spy: " + channel + " has a message of another type: " + e);
    }
  }

  List<MotionSample> takeHeard() {
    List<MotionSample> taken = new ArrayList<>();
    heard.drainTo(taken);
    return taken;
  }

  void close() {
    lcm.close();
  }

  private MotionSample sample(DataInput data) throws IOException {
    return fingerprint == odometry_t.LCM_FINGERPRINT
        ? MotionSample.of(new odometry_t(data))
        : MotionSample.of(new ego_motion_t(data));
  }
}
