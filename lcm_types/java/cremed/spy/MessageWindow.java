// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import cremed.ego_motion_t;
import cremed.odometry_t;
import cremed.radar_scan_t;
import cremed.status_t;
import java.awt.Container;
import java.awt.event.ActionEvent;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import java.util.Set;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.JScrollPane;
import javax.swing.JSplitPane;
import javax.swing.SwingUtilities;
import javax.swing.Timer;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/**
 * In lcm-spy: a channel's last message as a table, and curves of its motion, kept up to date.
 * lcm-spy finds it by itself.
 */
public final class MessageWindow implements SpyPlugin {
  private static final Set<Long> FINGERPRINTS =
      Set.of(
          ego_motion_t.LCM_FINGERPRINT,
          odometry_t.LCM_FINGERPRINT,
          radar_scan_t.LCM_FINGERPRINT,
          status_t.LCM_FINGERPRINT);
  private static final int REFRESH_MS = 200;
  private static final int TABLE_HEIGHT_PX = 230;

  @Override
  public boolean canHandle(long fingerprint) {
    return FINGERPRINTS.contains(fingerprint);
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return new AbstractAction("Table with names of statuses, and curves") {
      @Override
      public void actionPerformed(ActionEvent event) {
        fill((JFrame) SwingUtilities.getWindowAncestor(desktop), channel);
      }
    };
  }

  /** lcm-spy has opened the window, small and empty. */
  private static void fill(JFrame window, ChannelData channel) {
    MessageTable table = new MessageTable();
    JScrollPane scrolledTable = new JScrollPane(table);
    if (!MotionListener.isMotion(channel.fingerprint)) {
      show(window, scrolledTable, () -> table.show(channel.last), () -> {});
      return;
    }
    MotionListener listener = new MotionListener(channel.name, channel.fingerprint);
    MotionTabs tabs = new MotionTabs();
    JSplitPane both = new JSplitPane(JSplitPane.VERTICAL_SPLIT, scrolledTable, tabs);
    both.setDividerLocation(TABLE_HEIGHT_PX);
    Runnable refresh =
        () -> {
          table.show(channel.last);
          tabs.add(listener.takeHeard());
        };
    show(window, both, refresh, listener::close);
  }

  private static void show(
      JFrame window, Container content, Runnable refresh, Runnable close) {
    Timer timer = new Timer(REFRESH_MS, tick -> refresh.run());
    timer.setInitialDelay(0);
    timer.start();
    window.setDefaultCloseOperation(JFrame.DISPOSE_ON_CLOSE);
    window.addWindowListener(
        new WindowAdapter() {
          @Override
          public void windowClosed(WindowEvent event) {
            timer.stop();
            close.run();
          }
        });
    window.setContentPane(content);
    window.setSize(900, 700);
    window.validate();
  }
}
