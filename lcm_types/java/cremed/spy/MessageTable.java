// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
package cremed.spy;

import java.util.List;
import javax.swing.JTable;
import javax.swing.table.AbstractTableModel;

/** A message's fields, one a row. */
final class MessageTable extends JTable {
  private final Rows rows;

  MessageTable() {
    this(new Rows());
  }

  private MessageTable(Rows rows) {
    super(rows);
    this.rows = rows;
    getColumnModel().getColumn(0).setPreferredWidth(380);
    getColumnModel().getColumn(1).setPreferredWidth(420);
  }

  void show(Object message) {
    if (message != null) {
      rows.show(MessageRows.of(message));
    }
  }

  private static final class Rows extends AbstractTableModel {
    private List<String[]> rows = List.of();

    void show(List<String[]> latest) {
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
