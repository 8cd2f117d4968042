// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import cremed.ego_motion_t;
import cremed.odometry_t;
import cremed.radar_scan_t;
import cremed.status_t;
import java.awt.event.ActionEvent;
import java.util.List;
import java.util.Set;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.JScrollPane;
import javax.swing.JTable;
import javax.swing.Timer;
import javax.swing.table.AbstractTableModel;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** In lcm-spy: a channel's last message as a table, kept up to date. lcm-spy finds it by itself. */
public final class MessageTable implements SpyPlugin {
  private static final Set<Long> FINGERPRINTS =
      Set.of(
          ego_motion_t.LCM_FINGERPRINT,
          odometry_t.LCM_FINGERPRINT,
          radar_scan_t.LCM_FINGERPRINT,
          status_t.LCM_FINGERPRINT);
  private static final int REFRESH_MS = 200;

  @Override
  public boolean canHandle(long fingerprint) {
    return FINGERPRINTS.contains(fingerprint);
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return new AbstractAction("Table with names of statuses") {
      @Override
      public void actionPerformed(ActionEvent event) {
        open(channel);
      }
    };
  }

  private static void open(ChannelData channel) {
    Rows rows = new Rows();
    JTable table = new JTable(rows);
    table.getColumnModel().getColumn(0).setPreferredWidth(380);
    table.getColumnModel().getColumn(1).setPreferredWidth(420);
    Timer timer = new Timer(REFRESH_MS, tick -> rows.show(channel.last));
    timer.setInitialDelay(0);
    timer.start();
    JFrame frame = new JFrame(channel.name);
    frame.setDefaultCloseOperation(JFrame.DISPOSE_ON_CLOSE);
    frame.addWindowListener(
        new java.awt.event.WindowAdapter() {
          @Override
          public void windowClosed(java.awt.event.WindowEvent event) {
            timer.stop();
          }
        });
    frame.add(new JScrollPane(table));
    frame.setSize(800, 500);
    frame.setVisible(true);
  }

  private static final class Rows extends AbstractTableModel {
    private List<String[]> rows = List.of();

    void show(Object message) {
      if (message == null) {
        return;
      }
      List<String[]> latest = MessageRows.of(message);
      boolean isLonger = latest.size() != rows.size();
      rows = latest;
      if (isLonger) {
        fireTableDataChanged();
      } else if (!rows.isEmpty()) {
        fireTableRowsUpdated(0, rows.size() - 1); // Keeps selection and scroll position.
      }
    }

    @Override
    public int getRowCount() {
      return rows.size();
    }

    @Override
    public int getColumnCount() {
      return 2;
    }

    @Override
    public String getColumnName(int column) {
      return column == 0 ? "field" : "value";
    }

    @Override
    public Object getValueAt(int row, int column) {
      return rows.get(row)[column];
    }
  }
}
